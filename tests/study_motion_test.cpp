// How far two motions are apart, what that is relative to, and what a run leaves of a scene's motion.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bench/study/motion.h"
#include "bench/study/natural_end.h"
#include "core/conserved_energy.h"
#include "tests/support/rows_scene.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using study::Motion;
using study::PerQuantity;

Settings short_run(int outputs = 4) {
  Settings settings;
  settings.integrator = "dopri5";
  settings.reactions = true;
  settings.end = 0.4;
  settings.every = settings.end / outputs;
  return settings;
}

struct Moving {
  explicit Moving(const Scene& scene) : model(compile(scene)), motion(study::run_motion(scene, short_run()).motion) {
    check(motion.t.size() == 5, "the motion has its five instants");
    sizes = study::sizes(motion, model);
  }
  PerQuantity from(const Motion& other) const { return study::difference(other, motion, sizes, model); }

  Model model;
  Motion motion;
  study::Sizes sizes;
};

TEST(Difference, of_a_motion_from_itself_is_nothing) {
  const Moving m(rows_of_every_kind());
  EXPECT_EQ(m.from(m.motion), PerQuantity{});
}

TEST(Difference, is_relative_to_the_largest_of_its_kind) {
  const Moving m(scene_of("double_pendulum"));
  double r = 0, rd = 0, w = 0, rdd = 0, wd = 0;
  for (const auto& bodies : m.motion.bodies)
    for (const BodyState& body : bodies) {
      r = std::max(r, body.r.norm());
      rd = std::max(rd, body.rd.norm());
      w = std::max(w, body.w.norm());
      rdd = std::max(rdd, body.rdd.norm());
      wd = std::max(wd, body.wd.norm());
    }
  const Vector3 off(3e-3, 0, 4e-3);  // of length 5e-3
  const auto moved = [&](Vector3 BodyState::*member) {
    Motion other = m.motion;
    other.bodies[3][1].*member += off;
    return m.from(other);
  };
  const auto expect = [](const PerQuantity& found, std::size_t quantity, double value) {
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], k == quantity ? value : 0, 1e-15) << k;
  };
  expect(moved(&BodyState::r), 0, 5e-3 / r);
  expect(moved(&BodyState::rd), 1, 5e-3 / rd);
  expect(moved(&BodyState::w), 1, 5e-3 / w);
  expect(moved(&BodyState::rdd), 2, 5e-3 / rdd);
  expect(moved(&BodyState::wd), 2, 5e-3 / wd);
}

TEST(Difference, of_orientations_is_the_angle) {
  const Moving m(scene_of("double_pendulum"));
  for (const double angle : {1e-9, 0.3, 3.1, std::numbers::pi}) {
    Motion other = m.motion;
    other.bodies[2][0].A *= Eigen::AngleAxisd(angle, Vector3(2, -1, 2).normalized()).toRotationMatrix();
    EXPECT_NEAR(m.from(other)[0], angle, angle > 3.13 ? 1e-7 : 1e-12) << angle;
  }
}

TEST(Difference, of_multipliers_is_one_of_forces) {
  const Moving m(rows_of_every_kind());
  const double L = m.sizes.length;
  int kinds = 0;
  for (std::size_t row = 0; row < m.model.rows.size(); ++row) {
    Motion other = m.motion;
    other.lambda[1][row] += 0.25;
    double force = 0.25;  // N; a moment, N m, over the length; a force per length, N/m, times it
    const RowType type = m.model.rows[row].type;
    if (type == RowType::DP1 || type == RowType::angle) force /= L;
    if (type == RowType::D) force *= L;
    kinds |= 1 << static_cast<int>(type);
    EXPECT_NEAR(m.from(other)[3], force / m.sizes.force, 1e-12) << row;
  }
  for (const RowType type : {RowType::DP1, RowType::DP2, RowType::D, RowType::CD, RowType::pfaffian})
    EXPECT_TRUE(kinds & 1 << static_cast<int>(type)) << "no row of type " << static_cast<int>(type);
}

TEST(Difference, of_a_motion_that_ends_early_or_is_no_number) {
  const Moving m(scene_of("double_pendulum"));
  Motion other = m.motion;
  other.bodies[1][0].rd.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(m.from(other)[1]));
  EXPECT_EQ(m.from(other)[0], 0);
  other = m.motion;
  other.t.pop_back();
  other.bodies.pop_back();
  other.lambda.pop_back();
  for (const double d : m.from(other)) EXPECT_EQ(d, std::numeric_limits<double>::infinity());
}

TEST(Sizes, of_a_scene_at_rest_are_those_it_could_have) {
  Scene scene = scene_of("single_pendulum_free");
  scene.gravity.setZero();
  const Moving m(scene);
  const double L = m.sizes.length, T = m.motion.t.back();
  EXPECT_NEAR(L, scene.bodies[0].position.norm(), 1e-8);  // given to eight digits, and projected
  EXPECT_NEAR(m.sizes.velocity, L / T, 1e-12 * L / T);
  EXPECT_NEAR(m.sizes.angular_velocity, 1 / T, 1e-12 / T);
  EXPECT_NEAR(m.sizes.acceleration, L / T / T, 1e-12 * L / T / T);
  EXPECT_NEAR(m.sizes.force, scene.bodies[0].mass * m.sizes.acceleration, 1e-12 * m.sizes.force);
}

TEST(Sizes, a_body_that_only_turns_measures_its_translation_by_its_turning) {
  Scene scene = scene_of("double_pendulum");
  scene.gravity.setZero();
  scene.joints.clear();
  scene.constraints.clear();
  for (Body& body : scene.bodies) body.angular_velocity = {0, 0, 2};
  const Moving m(scene);
  EXPECT_NEAR(m.sizes.angular_velocity, 2, 1e-9);
  EXPECT_NEAR(m.sizes.velocity, 2 * m.sizes.length, 1e-8);
}

TEST(RunMotion, settings_that_do_not_fit_the_scene_are_a_failure) {
  Settings settings = short_run();
  settings.formulation = "no formulation";
  const study::MotionRun run = study::run_motion(scene_of("double_pendulum"), settings);
  EXPECT_FALSE(run.outcome.status.ok());
  EXPECT_NE(run.outcome.status.message.find("no formulation"), std::string::npos) << run.outcome.status.message;
  EXPECT_TRUE(run.motion.t.empty());
}

TEST(RunMotion, is_given_up_after_a_time) {
  const study::MotionRun run = study::run_motion(scene_of("double_pendulum"), short_run(), 0);
  EXPECT_FALSE(run.outcome.status.ok());
  EXPECT_NE(run.outcome.status.message.find("given up after 0 s"), std::string::npos) << run.outcome.status.message;
}

TEST(Energy, is_constant_where_nothing_drives_and_nothing_dissipates) {
  EXPECT_TRUE(conserves_energy(compile(scene_of("double_pendulum"))));
  EXPECT_FALSE(conserves_energy(compile(scene_of("four_link"))));  // driven
  EXPECT_FALSE(conserves_energy(compile(rows_of_every_kind())));   // damped springs
  const study::MotionRun run = study::run_motion(scene_of("double_pendulum"), short_run());
  const double kinetic = study::kinetic_energy(run.motion, compile(scene_of("double_pendulum")));
  EXPECT_GT(kinetic, 1);
  EXPECT_LT(run.energy_drift, 1e-6 * kinetic);
}

TEST(NaturalEnd, is_when_the_quickest_body_has_turned_through_15_rad) {
  Scene scene = scene_of("double_pendulum");
  scene.gravity.setZero();
  scene.joints.clear();
  scene.constraints.clear();
  // Told at the end of a step of the pilot, which may be long, and rounded.
  for (const double speed : {15.0, 0.5}) {
    for (Body& body : scene.bodies) body.angular_velocity = {0, 0, speed};
    const double turned = speed * study::natural_end(scene);
    EXPECT_GT(turned, 10) << speed;
    EXPECT_LT(turned, 60) << speed;
  }
  for (Body& body : scene.bodies) body.angular_velocity.setZero();
  EXPECT_NEAR(study::natural_end(scene), 1, 1e-12);  // nothing moves
}

}  // namespace
}  // namespace poinsot::test
