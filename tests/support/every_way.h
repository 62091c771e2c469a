// Every integrator of dynamics in every formulation it takes.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "formulations/registry.h"
#include "integrators/integrator.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

// Calls visit(settings) for each; how many these are.
template <class Visit>
int in_every_way(double step, double end, Visit&& visit) {
  int ways = 0;
  for (const FormulationEntry& formulation : formulations())
    for (const IntegratorEntry& integrator : integrators()) {
      if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, formulation.name)) continue;
      Settings settings = dynamics(formulation.name, step, end);
      settings.integrator = integrator.name;
      SCOPED_TRACE(fmt::format("{} {}", integrator.name, formulation.name));
      visit(settings);
      ++ways;
    }
  return ways;
}

}  // namespace poinsot::test
