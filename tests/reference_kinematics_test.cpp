// Kinematics of the three driven mechanisms in every spelling, against the tables of tests/reference.
#include <gtest/gtest.h>

#include <numbers>
#include <tuple>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

struct Spelling {
  std::string model, reference;
  int turned_body;  // whose frame differs from the reference's, or −1
};

std::ostream& operator<<(std::ostream& out, const Spelling& spelling) {
  return out << spelling.model;
}

// Frames of Haug's book: A = A_haug F.
const Matrix3 kTurn = (Matrix3() << 0, 0, 1, 0, 1, 0, -1, 0, 0).finished();

const Spelling kSpellings[] = {
    {"single_pendulum", "kin_single_pendulum", -1},
    {"single_pendulum_joints", "kin_single_pendulum", -1},
    {"four_link", "kin_four_link", -1},
    {"four_link_haug", "kin_four_link", 0},
    {"four_link_joints", "kin_four_link", -1},
    {"slider_crank", "kin_slider_crank", -1},
    {"slider_crank_haug", "kin_slider_crank", 2},
    {"slider_crank_joints", "kin_slider_crank", -1},
};

std::vector<Snapshot> in_reference_frames(std::vector<Snapshot> samples, int turned_body) {
  if (turned_body < 0) return samples;
  for (Snapshot& sample : samples) {
    BodyState& body = sample.bodies[static_cast<std::size_t>(turned_body)];
    body.A = (body.A * kTurn).eval();
    body.w = (kTurn.transpose() * body.w).eval();
    body.wd = (kTurn.transpose() * body.wd).eval();
  }
  return samples;
}

// Positions and matrices to 1e-11, velocities to 1e-10, accelerations to 1e-9, relative to the largest value.
void expect_reference(const std::vector<Snapshot>& samples, const Spelling& spelling, const std::string& which) {
  const Distance d = distance(in_reference_frames(samples, spelling.turned_body), reference_motion(spelling.reference));
  EXPECT_LT(d.r, 1e-11) << which << ": " << d;
  EXPECT_LT(d.A, 1e-11) << which << ": " << d;
  EXPECT_LT(d.rd, 1e-10) << which << ": " << d;
  EXPECT_LT(d.w, 1e-10) << which << ": " << d;
  EXPECT_LT(d.rdd, 1e-9) << which << ": " << d;
  EXPECT_LT(d.wd, 1e-9) << which << ": " << d;
}

class ReferenceKinematics : public ::testing::TestWithParam<std::tuple<Spelling, std::string, std::string>> {};

TEST_P(ReferenceKinematics, IsTheReference) {
  const auto& [spelling, formulation, jacobian] = GetParam();
  const Scene scene = scene_of(spelling.model);
  for (double step : {1e-2, 1e-3}) {
    if (step < 1e-2 && spelling.reference != "kin_" + spelling.model) continue;  // the paper's step: its models
    Settings settings = kinematics(formulation, step, 3, 0.1);
    settings.jacobian = jacobian;
    expect_reference(motion(scene, settings), spelling, fmt::format("step {}", step));
  }
}

INSTANTIATE_TEST_SUITE_P(All, ReferenceKinematics,
                         ::testing::Combine(::testing::ValuesIn(kSpellings), ::testing::ValuesIn(formulation_names()),
                                            ::testing::ValuesIn(jacobian_names())),
                         [](const auto& test) {
                           return std::get<0>(test.param).model + "_" + std::get<1>(test.param) + "_" +
                                  std::get<2>(test.param);
                         });

// The tolerance the paper's tables are made with is enough: Newton's last correction is far above what remains.
TEST(ReferenceKinematicsTolerance, ThePapersIsEnough) {
  for (const std::string& formulation : formulation_names()) {
    Settings settings = kinematics(formulation, 1e-2, 3, 0.1);
    settings.tolerance = 1e-10;
    expect_reference(motion(scene_of("four_link"), settings), {"four_link", "kin_four_link", -1}, formulation);
  }
}

TEST(ReferenceKinematicsLinearSolvers, AllGiveTheReference) {
  for (const LinearSolverEntry& entry : linear_solvers()) {
    for (const std::string& formulation : formulation_names()) {
      Settings settings = kinematics(formulation, 1e-2, 3, 0.1);
      settings.linear_solver = entry.name;
      const Recorded r = run(scene_of("slider_crank"), settings);
      ASSERT_TRUE(r.outcome.status.ok()) << entry.name << ": " << r.outcome.status.message;
      expect_reference(r.samples, {"slider_crank", "kin_slider_crank", -1},
                       fmt::format("{} {}", formulation, entry.name));
    }
  }
}

// One at the prediction and one for rates; a kept matrix is that of the position before, which its rates asked for.
TEST(ReferenceKinematicsKept, FactorsOnceAStep) {
  for (const std::string& formulation : formulation_names()) {
    Settings settings = kinematics(formulation, 1e-3, 1, 1);
    settings.tolerance = 1e-10;
    for (const auto& [jacobian, a_step] : {std::pair{"exact", 2}, std::pair{"kept", 1}}) {
      settings.jacobian = jacobian;
      const Statistics s = run(scene_of("four_link"), settings).outcome.statistics;
      EXPECT_GE(s.factorizations, a_step * s.steps) << formulation << ' ' << jacobian;
      EXPECT_LE(s.factorizations, (a_step + 0.05) * static_cast<double>(s.steps)) << formulation << ' ' << jacobian;
    }
  }
}

// The slider's position in closed form.
TEST(ReferenceKinematicsClosedForm, SliderCrank) {
  for (const std::string& formulation : formulation_names()) {
    for (const Snapshot& sample : motion(scene_of("slider_crank"), kinematics(formulation, 1e-2, 2))) {
      const double angle = 2 * std::numbers::pi * sample.t;
      const double y = 0.1 + 0.08 * std::sin(angle), z = 0.12 + 0.08 * std::cos(angle);
      EXPECT_NEAR(sample.bodies[2].r.x(), std::sqrt(0.09 - y * y - z * z), 1e-12) << formulation << ' ' << sample.t;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
