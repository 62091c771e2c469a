// The formulations by name. Help texts, error messages, conformance tests and benchmarks are made from this table.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/registry.h"
#include "formulations/derivative_check.h"
#include "formulations/formulation.h"
#include "formulations/problem.h"

namespace poinsot {

struct FormulationEntry {
  std::string_view name;
  std::string_view about;  // one line: what it is, what it refuses
  CoordinateSpace space;   // what its coordinates are: decides who may use it
  // A problem over the rows of the model; rows listed in `dropped` (sorted) take no part: they are dependent.
  std::unique_ptr<Problem> (*make)(std::shared_ptr<const Model> model, std::span<const int> dropped);
  // Every analytic derivative at t = 0 and the states, one per body (formulations/derivative_check.h).
  std::vector<DerivativeCheck> (*check_derivatives)(const Model& model, std::span<const BodyState> states);
};

// In formulations/formulation_entry.h.
template <Formulation F>
FormulationEntry formulation_entry();

Registry<FormulationEntry>& formulations();

// The formulation in which a mechanism's state is judged, whatever formulation its motion is computed in: ranks,
// initial states, reactions. The first on a Lie group, whose velocities are the bodies' own, six each, and never
// singular.
const FormulationEntry& intrinsic_formulation();

}  // namespace poinsot
