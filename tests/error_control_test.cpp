// The integrators that control their error: digits of public benchmark problems, errors along with the tolerance,
// samples between the steps, failures.
#include <gmock/gmock.h>

#include <algorithm>

#include "core/input_error.h"
#include "core/so3.h"
#include "tests/support/allocations.h"
#include "tests/support/forced_scene.h"
#include "tests/support/momentary_spin.h"
#include "tests/support/rows_scene.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

// How exact a method can be, and how far its error at the end may be from the tolerance.
struct Precision {
  std::string_view integrator;
  double rtol, bound;  // the tightest tolerance it is asked for, and what it then has to reach
  double growth;       // errors at the end in units of the tolerance
};
constexpr Precision kPrecision[] = {{"auto", 1e-12, 1e-9, 50},
                                    {"dopri5", 1e-12, 4e-9, 50},
                                    {"dop853", 1e-12, 1e-9, 50},
                                    {"ida", 1e-12, 1e-9, 200},
                                    {"radau5", 1e-14, 2e-9, 200}};

// Every integrator with error control in every formulation it does not refuse.
struct ControlledMethod {
  Precision of;
  std::string formulation;
};
std::vector<ControlledMethod> methods() {
  std::vector<ControlledMethod> all;
  for (const IntegratorEntry& entry : integrators()) {
    if (!entry.controls_error) continue;
    const auto of = std::ranges::find(kPrecision, entry.name, &Precision::integrator);
    check(of != std::end(kPrecision), "it is known how exact an integrator with error control is");
    for (const std::string& formulation : formulation_names()) {
      if (!refusal_of(entry, formulation)) all.push_back({*of, formulation});
    }
  }
  return all;
}

class ErrorControl : public ::testing::TestWithParam<ControlledMethod> {
 protected:
  Settings settings(double rtol, double end, double every = 0) const {
    return controlled(GetParam().of.integrator, GetParam().formulation, rtol, end, every);
  }
  // The bodies at the end of a run that has to reach it, as exactly as the method can.
  std::vector<BodyState> final_bodies(std::string_view model, double end) const {
    return motion(scene_of(model), settings(GetParam().of.rtol, end, end)).back().bodies;
  }
  double bound() const { return GetParam().of.bound; }
};

INSTANTIATE_TEST_SUITE_P(All, ErrorControl, ::testing::ValuesIn(methods()), [](const auto& test) {
  return std::string(test.param.of.integrator) + "_" + test.param.formulation;
});

// Digits: IFToMM benchmark library, IVP test set, and extrapolation in extended precision; all of them are given.
TEST_P(ErrorControl, SimplePendulum) {
  const BodyState body = final_bodies("simple_pendulum", 10)[0];
  EXPECT_LT((body.r - Vector3(-0.27508746257612, -0.96141920509913, 0)).norm(), bound());
  EXPECT_LT((body.rd - Vector3(4.17559810095173, -1.19474905456048, 0)).norm(), bound() * body.rd.norm());
}

TEST_P(ErrorControl, HeavyTop) {
  const BodyState body = final_bodies("heavy_top", 1)[0];
  const Matrix3 A = rotation_from_parameters<double>(
      Vec4<double>(0.73294398067966, -0.27828571933761, 0.53182461133416, -0.32017614273625));
  EXPECT_LT((body.r - Vector3(0.17334396409839, 0.64008859207057, -0.74849079113358)).norm(), bound());
  EXPECT_LT((body.A - A).norm(), bound());  // after a turn of 150 rad
}

TEST_P(ErrorControl, FreeBody) {
  const BodyState body = final_bodies("free_body", 20)[0];
  EXPECT_LT((body.w - Vector3(-0.10532100800937, -0.99443877904670, 0.06081259389334)).norm(), bound());
}

TEST_P(ErrorControl, Andrews) {
  const std::vector<BodyState> bodies = final_bodies("andrews", 0.03);
  const double angles[] = {15.81077119515371, 15.81077119515371 - 15.75637105841184, 0.0408222401196456};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT((bodies[k].A.col(0) - Vector3(std::cos(angles[k]), std::sin(angles[k]), 0)).norm(), bound()) << k;
  }
  EXPECT_NEAR(bodies[0].w.y(), 1139.920302259106, 1139 * bound());
}

TEST_P(ErrorControl, DoublePendulum) {
  const auto samples = motion(scene_of("double_pendulum"), settings(GetParam().of.rtol, 5, 0.1));
  const auto reference = reference_motion("ode_double_pendulum");
  ASSERT_EQ(samples.size(), reference.size());
  EXPECT_LT(distance(samples, reference).largest(), bound());
  const std::vector<BodyState>& bodies = samples.back().bodies;
  EXPECT_LT((bodies[0].r - Vector3(0, 1.786577045777, -0.898967440736)).norm(), bound());
  EXPECT_LT((bodies[1].r - Vector3(0, 4.572906435978, -1.775680672486)).norm(), bound());
}

// A row that constrains velocities only.
TEST_P(ErrorControl, KnifeEdge) {
  const double c = 9.81 / 2, w = 2;
  const BodyState body = final_bodies("knife_edge", 1)[0];
  const Vector3 r(c * std::pow(std::sin(w), 2) / (2 * w * w), c * (w - std::sin(2 * w) / 2) / (2 * w * w), 0);
  EXPECT_LT((body.r - r).norm(), bound());
}

TEST_P(ErrorControl, TakesDriversAndRedundantRows) {
  for (const Scene& scene : {rows_of_every_kind(), scene_of("four_link"), scene_of("slider_crank_joints")}) {
    const auto exact = motion(scene, controlled("dop853", "rA", 1e-12, 0.4, 0.1));
    const Recorded r = run(scene, settings(1e-8, 0.4, 0.1));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    const Distance d = distance(r.samples, exact);
    EXPECT_LT(std::max({d.r, d.A, d.rd, d.w}), GetParam().of.growth * 1e-8) << scene.name << ": " << d;
    EXPECT_LT(r.outcome.statistics.violation.position, 1e-12) << scene.name;
    EXPECT_LT(r.outcome.statistics.violation.velocity, 1e-11) << scene.name;
  }
}

TEST_P(ErrorControl, TakesEveryLinearSolver) {
  Settings s = settings(1e-7, 0.5, 0.5);
  const auto expected = motion(forced(), s);
  for (const LinearSolverEntry& solver : linear_solvers()) {
    s.linear_solver = solver.name;
    const Recorded r = run(forced(), s);
    ASSERT_TRUE(r.outcome.status.ok()) << solver.name << ": " << r.outcome.status.message;
    EXPECT_LT(distance(r.samples, expected).largest(), 1e-5) << solver.name;
  }
}

TEST_P(ErrorControl, ErrorsFollowTheTolerance) {
  const Scene scene = forced();
  const double end = 2;
  const auto exact = motion(scene, controlled("dop853", "rA", 1e-13, end, end));
  std::int64_t before = 0;
  for (const double rtol : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const Recorded r = run(scene, settings(rtol, end, end));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_LT(distance(r.samples, exact).largest(), GetParam().of.growth * rtol) << rtol;
    EXPECT_GT(r.outcome.statistics.steps, before);
    EXPECT_LT(r.outcome.statistics.rejected_steps, r.outcome.statistics.steps / 4 + 4);
    before = r.outcome.statistics.steps;
  }
}

// Between the steps as good as at them; and on the constraints.
TEST_P(ErrorControl, SamplesByDenseOutput) {
  const Scene scene = forced();
  const double end = 2, every = 0.013;
  const auto exact = motion(scene, controlled("dop853", "rA", 1e-13, end, every));
  for (const double rtol : {1e-6, 1e-9}) {
    const Recorded r = run(scene, settings(rtol, end, every));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_LT(distance(r.samples, exact).largest(), 2 * GetParam().of.growth * rtol) << rtol;
    EXPECT_LT(r.outcome.statistics.violation.position, 1e-13) << rtol;
    EXPECT_LT(r.outcome.statistics.violation.velocity, 1e-12) << rtol;

    const Recorded ends = run(scene, settings(rtol, end, end));  // sampling does not change the motion
    EXPECT_EQ(ends.outcome.statistics.steps, r.outcome.statistics.steps);
    EXPECT_LT(distance({ends.samples.back()}, {r.samples.back()}).largest(), 1e-11);
  }
}

TEST_P(ErrorControl, SamplesAreMultiplesAndTheEnd) {
  const Scene scene = scene_of("double_pendulum");
  const auto times = [&](double end, double every) {
    std::vector<double> t;
    for (const Snapshot& sample : motion(scene, settings(1e-7, end, every))) t.push_back(sample.t);
    return t;
  };
  EXPECT_THAT(times(1, 0.25), ::testing::ElementsAre(0, 0.25, 0.5, 0.75, 1));
  EXPECT_THAT(times(1, 0.3), ::testing::ElementsAre(0, 0.3, 2 * 0.3, 3 * 0.3, 1));
  EXPECT_THAT(times(0.1, 2), ::testing::ElementsAre(0, 0.1));
  const std::vector<double> tenths = times(0.7, 0.1);
  ASSERT_EQ(tenths.size(), 8u);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(tenths[k], k == 7 ? 0.7 : 0.7 * (static_cast<double>(k) / 7));

  const Recorded all = run(scene, settings(1e-7, 1));
  EXPECT_EQ(all.samples.size(), static_cast<std::size_t>(all.outcome.statistics.steps) + 1);
  EXPECT_EQ(all.samples.back().t, 1);
}

TEST_P(ErrorControl, IsDeterministic) {
  const Settings s = settings(1e-8, 2, 0.01);
  const auto once = motion(forced(), s), again = motion(forced(), s);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t n = 0; n < once.size(); ++n) {
    EXPECT_EQ(once[n].lambda, again[n].lambda) << n;
    for (std::size_t b = 0; b < once[n].bodies.size(); ++b) EXPECT_EQ(once[n].bodies[b].A, again[n].bodies[b].A) << n;
  }
}

// Nor do samples between the steps, changes of chart and rejected steps.
TEST_P(ErrorControl, StepsAllocateNothing) {
  for (const Scene& scene : {forced(), scene_of("heavy_top"), scene_of("double_pendulum")}) {
    for (const double every : {0.0, 0.003}) {
      Settings s = settings(1e-7, 0.3, every);
      s.linear_solver = "dense";  // klu allocates fresh pivots
      long samples = 0, allocated = 0;
      const Outcome outcome = simulate(scene, s, [&](const Sample&) {
        const long now = allocations();
        EXPECT_TRUE(++samples <= 3 || now == allocated) << now - allocated << " before sample " << samples;
        allocated = now;
      });
      EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
      EXPECT_GT(samples, 5);
    }
  }
}

TEST_P(ErrorControl, StopsWhereAForceGrowsWithoutBound) {
  Scene scene = scene_of("double_pendulum");
  Torque torque;
  torque.body = 0;
  torque.torque[2] = Expression::parse("100/(0.5-t)^3");
  scene.forces.emplace_back(torque);
  const Recorded r = run(scene, settings(1e-8, 1));
  EXPECT_EQ(r.outcome.status.failure, Failure::not_finite);
  EXPECT_NEAR(r.outcome.status.time, 0.5, 0.01);
  EXPECT_THAT(r.outcome.status.message,
              HasSubstr("force 'torque1' (/forces/0), component z: '100/(0.5-t)^3' grows without bound "
                        "towards t = 0.5 s; end the run before"));
  EXPECT_THAT(r.outcome.status.message, ::testing::Not(HasSubstr("beside a singular position")));
  ASSERT_GT(r.samples.size(), 2u);  // those before are good
  EXPECT_LE(r.samples.back().t, r.outcome.status.time);
  EXPECT_TRUE(r.samples.back().bodies[0].A.allFinite());
  EXPECT_TRUE(run(scene, settings(1e-8, 0.45)).outcome.status.ok());
}

// What nothing holds comes to no singular position.
TEST_P(ErrorControl, StopsAFreeBodyWhoseForceGrowsWithoutBound) {
  Scene scene;
  Body& ball = scene.bodies.emplace_back();
  ball.name = "ball", ball.mass = 1, ball.inertia = Matrix3::Identity();
  PointForce push;
  push.body = 0, push.force[0] = Expression::parse("1/(0.5 - t)^2");
  scene.forces.emplace_back(push);
  const Recorded r = run(scene, settings(1e-8, 1));
  EXPECT_EQ(r.outcome.status.failure, Failure::not_finite);
  EXPECT_NEAR(r.outcome.status.time, 0.5, 0.01);
  EXPECT_THAT(r.outcome.status.message,
              HasSubstr("force 'force1' (/forces/0), component x: '1/(0.5 - t)^2' grows without bound "
                        "towards t = 0.5 s; end the run before"));
  EXPECT_THAT(r.outcome.status.message, ::testing::Not(HasSubstr("singular")));
}

// With nothing but a relative tolerance no step resolves the rounding of a body at rest, which rp has in plane motion.
TEST_P(ErrorControl, SaysThatTheTolerancesAskForTooMuch) {
  Settings s = settings(1e-14, 0.5);
  s.atol = 1e-120;
  for (const double end : {0.5, 0.01}) {
    if (GetParam().formulation != "rp") continue;
    s.end = end;
    const Outcome outcome = simulate(scene_of("double_pendulum"), s, {});
    EXPECT_EQ(outcome.status.failure, Failure::step_size_too_small) << end;
    EXPECT_THAT(outcome.status.message, HasSubstr("where a body is at rest, atol alone does")) << end;
    EXPECT_LT(outcome.statistics.steps + outcome.statistics.rejected_steps, 30000) << end;
    EXPECT_THAT(outcome.status.message, HasSubstr("larger tolerances or an implicit integrator")) << end;
    EXPECT_TRUE(simulate(scene_of("double_pendulum"), settings(1e-8, end), {}).status.ok());
    Settings fixed = settings(1e-8, end);
    fixed.integrator = "implicit_euler";
    EXPECT_TRUE(simulate(scene_of("double_pendulum"), fixed, {}).status.ok());
  }
  s.rtol = 1e-15;
  try {
    (void)simulate(scene_of("double_pendulum"), s, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "rtol: found 1e-15, expected a number from 2.2e-15 to 1");
  }
}

TEST_P(ErrorControl, NeedsNoAbsoluteToleranceWhereEverythingMoves) {
  const Scene scene = scene_of("heavy_top");
  Settings s = settings(1e-8, 0.1, 0.1);
  const auto usual = motion(scene, s);
  s.atol = 1e-120;
  EXPECT_LT(distance(motion(scene, s), usual).largest(), 1e-6);
}

// The longest steps are longer than what a polynomial between their ends can follow.
TEST_P(ErrorControl, LooseTolerancesGiveSamples) {
  const Scene scene = scene_of("double_pendulum");
  const auto exact = motion(scene, controlled("dop853", "rA", 1e-10, 1.5, 0.05));
  for (const double rtol : {3e-2, 1e-2}) {
    const Recorded r = run(scene, settings(rtol, 1.5, 0.05));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_LT(r.outcome.statistics.violation.position, 1e-12);
    const Distance d = distance(r.samples, exact);
    EXPECT_LT(std::max({d.r, d.A, d.rd, d.w}), GetParam().of.growth * rtol) << rtol << ": " << d;
    const Recorded later = run(scene, settings(rtol, 5, 0.05));
    EXPECT_TRUE(later.outcome.status.ok()) << later.outcome.status.message;
  }
}

// Fast spin and loose tolerances: samples between the steps neither stop a run nor stand out from it.
TEST_P(ErrorControl, SamplesDoNotStopARun) {
  const Scene scene = scene_of("heavy_top");
  const double end = 0.1, every = 1e-3;
  const auto exact = motion(scene, controlled("dop853", "rA", 1e-12, end, every));
  for (const double rtol : {1e-3, 3e-4, 1e-4, 3e-5}) {
    const Recorded ends = run(scene, settings(rtol, end, end)), r = run(scene, settings(rtol, end, every));
    ASSERT_TRUE(ends.outcome.status.ok()) << ends.outcome.status.message;
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_EQ(ends.outcome.statistics.steps, r.outcome.statistics.steps);
    EXPECT_LT(distance(r.samples, exact).largest(), GetParam().of.growth * rtol) << rtol;
  }
}

// An output time in the middle of a long step: there the ZXZ angles, which steps leave before they are singular, would
// be. A turning body whose third axis comes to the z axis at t = 0.5; truth in closed form.
TEST_P(ErrorControl, SamplesWhereAnglesAreSingular) {
  for (const double least : {0.0, 1e-12, 1e-6}) {
    Scene scene;
    Body& body = scene.bodies.emplace_back();
    body.name = "body", body.mass = 1, body.inertia = Vector3(1, 1, 2).asDiagonal();
    const auto turned = [&](double t) -> Matrix3 {
      return (Eigen::AngleAxisd(2 * t - 1, Vector3::UnitX()) * Eigen::AngleAxisd(least, Vector3::UnitY()))
          .toRotationMatrix();
    };
    body.orientation = turned(0);
    body.position = body.orientation.col(2);
    body.velocity = Vector3(2, 0, 0).cross(body.position);
    body.angular_velocity = body.orientation.transpose() * Vector3(2, 0, 0);
    Joint& ball = scene.joints.emplace_back();
    ball.name = "ball", ball.type = JointType::spherical, ball.i = kGround, ball.j = 0, ball.point = Vector3::Zero();
    for (const double rtol : {1e-4, 1e-6})
      for (const double every : {0.1, 0.25, 0.5})
        for (const Snapshot& sample : motion(scene, settings(rtol, 1, every)))
          EXPECT_LT((sample.bodies[0].A - turned(sample.t)).norm(), 200 * rtol)
              << least << ' ' << rtol << ' ' << sample.t;
  }
}

TEST_P(ErrorControl, StopsAtASingularStart) {
  Scene scene = scene_of("double_pendulum");  // and a rod without inertia, whose rotation nothing holds there
  scene.bodies.emplace_back(scene.bodies[1]).name = "rod";
  spin_at_the_start(scene, 2);
  const Outcome outcome = simulate(scene, settings(1e-8, 1), {});
  EXPECT_EQ(outcome.status.failure, Failure::singular_matrix);
  EXPECT_EQ(outcome.statistics.steps, 0);
}

// Two rods stretched by a driver of the distance of their ends, which goes on where they are in one line.
TEST(SingularPosition, IsToldWhereARunStops) {
  Scene scene;
  const double bend = std::acos(0.75);  // 1.5 m from end to end
  for (int k = 0; k < 2; ++k) {
    Body& rod = scene.bodies.emplace_back();
    rod.name = fmt::format("rod{}", k + 1);
    rod.mass = 1, rod.inertia = Vector3(0.01, 0.1, 0.1).asDiagonal();
    rod.orientation = Eigen::AngleAxisd(k == 0 ? bend : -bend, Vector3::UnitZ()).toRotationMatrix();
    rod.position = Vector3(0.375 + 0.75 * k, 0.5 * std::sin(bend), 0);
    Joint& joint = scene.joints.emplace_back();
    joint.name = fmt::format("joint{}", k + 1);
    joint.i = k == 0 ? kGround : 0, joint.j = k;
    joint.point = Vector3(0.75 * k, k * std::sin(bend), 0), joint.axis = Vector3::UnitZ();
  }
  Constraint& reach = scene.constraints.emplace_back();
  reach.name = "reach", reach.type = ConstraintType::D, reach.i = kGround, reach.j = 1;
  reach.s_j = Vector3(0.5, 0, 0), reach.f = Expression::parse("(1.5+t)^2");
  for (const IntegratorEntry& integrator : integrators()) {
    if (!integrator.controls_error) continue;
    SCOPED_TRACE(integrator.name);
    const Outcome outcome = simulate(scene, controlled(integrator.name, "rp", 1e-8, 1), {});
    EXPECT_FALSE(outcome.status.ok());
    EXPECT_NEAR(outcome.status.time, 0.5, 1e-3);
    EXPECT_THAT(outcome.status.message, HasSubstr("singular position"));
  }
  Settings euler;
  euler.integrator = "implicit_euler";
  euler.end = 10;
  const Outcome newton = simulate(scene_of("double_four_bar"), euler, {});
  EXPECT_TRUE(newton.status.ok()) << newton.status.message;  // its steps go over all of them
}

}  // namespace
}  // namespace poinsot::test
