// Of redundant rows those that are kept wear out at their own pace: error control is not to creep up to where they
// depend on one another while the mechanism is regular.
#include <gtest/gtest.h>

#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

class RowWear : public ::testing::TestWithParam<std::string> {};

// Its kept rows change little up to half way to where three of them fall together.
TEST_P(RowWear, IsSeenWhereItBeginsLate) {
  const Scene scene = read_scene(POINSOT_SOURCE_DIR "/tests/scenes/sarrus_four_legs.json");
  for (const char* integrator : {"radau5", "dop853"})
    for (const double rtol : {1e-8, 1e-10}) {
      const Recorded r = run(scene, controlled(integrator, GetParam(), rtol, 0.3, 0.3));
      EXPECT_TRUE(r.outcome.status.ok()) << integrator << ' ' << rtol << ": " << r.outcome.status.message;
    }
}

// Steps that are rejected again and again ask for others.
TEST_P(RowWear, IsLookedForWhereStepsAreRejected) {
  const Scene scene = read_scene(POINSOT_SOURCE_DIR "/tests/scenes/parallel_cranks.json");
  const Recorded r = run(scene, controlled("auto", GetParam(), 1e-10, 1, 1));
  EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
}

INSTANTIATE_TEST_SUITE_P(All, RowWear, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace poinsot::test
