// The registry's entry of a formulation, made from its traits: what a formulation's own source file instantiates.
//
// A new formulation is its header, a source file with one line, and a line in formulations/list.h; a program adds one
// of its own by formulations().add(formulation_entry<Mine>()), and includes formulations/derivative_checker.h for it.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "formulations/derivative_check.h"
#include "formulations/mechanism_problem.h"
#include "formulations/registry.h"

namespace poinsot {

template <Formulation F>
FormulationEntry formulation_entry() {
  return {F::name, F::about, F::space,
          [](std::shared_ptr<const Model> model, std::span<const int> dropped) -> std::unique_ptr<Problem> {
            return std::make_unique<MechanismProblem<F>>(std::make_shared<const Elements>(std::move(model), dropped));
          },
          check_derivatives_in<F>};
}

}  // namespace poinsot
