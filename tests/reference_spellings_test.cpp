// A mechanism written with the four constraints and one written with joints move the same.
#include <gtest/gtest.h>

#include <tuple>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using Written = std::tuple<std::string, std::string>;  // model, formulation

std::string name_of(const ::testing::TestParamInfo<Written>& test) {
  return std::get<0>(test.param) + "_" + std::get<1>(test.param);
}

class KinematicsOfSpellings : public ::testing::TestWithParam<Written> {};

TEST_P(KinematicsOfSpellings, IsTheSame) {
  const auto& [model, formulation] = GetParam();
  const Settings settings = kinematics(formulation, 1e-2, 3);
  const Distance d = distance(motion(scene_of(model + "_joints"), settings), motion(scene_of(model), settings));
  EXPECT_LT(d.largest(), 1e-10) << d;
}

INSTANTIATE_TEST_SUITE_P(All, KinematicsOfSpellings,
                         ::testing::Combine(::testing::Values("single_pendulum", "four_link", "slider_crank"),
                                            ::testing::ValuesIn(formulation_names())),
                         name_of);

class DynamicsOfSpellings : public ::testing::TestWithParam<Written> {};

// The rows differ, what they span does not: the reactions do, so the discrete motion does.
TEST_P(DynamicsOfSpellings, IsTheSame) {
  const auto& [model, formulation] = GetParam();
  Settings settings = dynamics(formulation, 5e-3, 1);
  settings.tolerance *= 1e-2;
  const Distance d = distance(motion(scene_of(model + "_joints"), settings), motion(scene_of(model), settings));
  EXPECT_LT(d.largest(), 1e-9) << d;
}

INSTANTIATE_TEST_SUITE_P(All, DynamicsOfSpellings,
                         ::testing::Combine(::testing::Values("single_pendulum", "double_pendulum", "four_link",
                                                              "slider_crank"),
                                            ::testing::ValuesIn(formulation_names())),
                         name_of);

}  // namespace
}  // namespace poinsot::test
