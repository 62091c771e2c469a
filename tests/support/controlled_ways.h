// Every integrator with error control in every formulation it takes, as parameters of tests.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formulations/registry.h"
#include "integrators/integrator.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

struct ControlledWay {
  std::string integrator, formulation;
};

inline std::vector<ControlledWay> controlled_ways() {
  std::vector<ControlledWay> all;
  for (const IntegratorEntry& entry : integrators())
    for (const FormulationEntry& formulation : formulations())
      if (entry.controls_error && !refusal_of(entry, formulation.name))
        all.push_back({std::string(entry.name), std::string(formulation.name)});
  return all;
}

inline std::string name_of_way(const ::testing::TestParamInfo<ControlledWay>& test) {
  return test.param.integrator + "_" + test.param.formulation;
}

class ControlledWays : public ::testing::TestWithParam<ControlledWay> {
 protected:
  Settings settings(double rtol, double end, double every) const {
    return controlled(GetParam().integrator, GetParam().formulation, rtol, end, every);
  }
};

}  // namespace poinsot::test
