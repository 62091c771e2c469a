// Runs that stop, or doubt what they compute, and what they say to try: applied to the same scene it helps.
#include "tests/support/remedies.h"

#include <gtest/gtest.h>

#include "tests/support/every_way.h"
#include "tests/support/loops.h"
#include "tests/support/twice_driven.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kFixedMethods[] = {"implicit_euler", "half_implicit", "rattle", "generalized_alpha",
                                         "generalized_alpha_i2"};

Settings usual(std::string_view integrator, std::string_view formulation, double step, double end) {
  Settings s;
  s.integrator = integrator, s.formulation = formulation;
  s.step = step, s.end = end;
  s.tolerance = 1e-8;
  return s;
}

template <class Change>
Settings changed(Settings s, const Change& change) {
  change(s);
  return s;
}

class Remedies : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, Remedies, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

TEST_P(Remedies, OfTooFewIterations) {
  const Scene scene = scene_of("double_pendulum_joints");
  for (const char* integrator : kFixedMethods) {
    SCOPED_TRACE(integrator);
    Settings settings = usual(integrator, GetParam(), 1e-2, 0.1);
    settings.max_iterations = 1;
    settings.retry = false;
    expect_stopped(run(scene, settings), Failure::not_converged, "'",
                   "try a smaller step, more iterations or a larger tolerance");
    expect_helped(scene, changed(settings, [](Settings& s) { s.max_iterations = 20; }));
    expect_helped(scene, changed(settings, [](Settings& s) { s.tolerance = 1; }));
  }
}

// Far too long steps: neither iterations nor tolerances are offered, which would make nonsense of it.
TEST_P(Remedies, OfStepsThatDiverge) {
  const Scene scene = loop({4, Frames::random, true, true});
  int stopped = 0;
  for (const char* integrator : kFixedMethods) {
    for (const char* jacobian : {"exact", "simplified"}) {
      SCOPED_TRACE(fmt::format("{} {}", integrator, jacobian));
      Settings settings = usual(integrator, GetParam(), 0.1, 1);
      settings.jacobian = jacobian;
      const Recorded r = run(scene, settings);
      if (r.outcome.status.failure != Failure::not_converged) continue;
      ++stopped;
      const std::string& message = r.outcome.status.message;
      EXPECT_EQ(message.find("exact jacobian") != message.npos, settings.jacobian != "exact") << message;
      std::smatch correction;
      ASSERT_TRUE(std::regex_search(message, correction, std::regex("the correction is ([0-9.e+-]+),")));
      if (std::stod(correction[1]) > 1e-3) {
        EXPECT_THAT(message, Not(HasSubstr("larger tolerance")));
      }
      if (message.find("error control") != message.npos)
        expect_helped(scene, changed(settings, [](Settings& s) { s.integrator = "dop853"; }));
      else
        expect_helped(scene, changed(settings, [](Settings& s) { s.step = 5e-3; }));
    }
  }
  EXPECT_GT(stopped, 0);
}

// It does no step in parts, and says so by what it offers.
TEST(RemediesOfGeneralizedAlphaI2, AreSmallerSteps) {
  for (const auto& [model, formulation, step] :
       {std::tuple{"heavy_top", "reps", 0.0125}, {"gyroscope", "rA", 0.05}, {"four_link_haug", "reps", 0.1}}) {
    SCOPED_TRACE(model);
    const Settings settings = usual("generalized_alpha_i2", formulation, step, 1);
    expect_stopped(run(scene_of(model), settings), Failure::not_converged, "'", "; try a smaller step");
    expect_helped(scene_of(model), changed(settings, [](Settings& s) { s.step /= 10; }));
  }
}

// A bob on a guide with a spring or damper faster than the steps.
Scene stiff_bob(double stiffness, double damping) {
  Scene scene;
  Body& bob = scene.bodies.emplace_back();
  bob.name = "bob", bob.mass = 1, bob.inertia = Matrix3::Identity(), bob.position = {1, 0, 0};
  Spring spring;
  spring.name = "spring", spring.i = kGround, spring.j = 0;
  spring.stiffness = stiffness, spring.damping = damping, spring.length = 0.99;
  scene.forces.emplace_back(spring);
  Joint& guide = scene.joints.emplace_back();
  guide.name = "guide", guide.type = JointType::translational, guide.i = kGround, guide.j = 0, guide.axis = {1, 0, 0};
  return scene;
}

double farthest(const Recorded& r) {
  double most = 0;
  for (const Snapshot& s : r.samples) most = std::max(most, std::abs(s.bodies[0].r.x() - 0.99));
  return most;
}

TEST_P(Remedies, OfWhatGrowsWithoutBound) {
  const Scene scene = stiff_bob(1e6, 0);
  const auto grows = Contains(HasSubstr("grows without bound; try integrator radau5 or generalized_alpha, or a"));
  for (const char* integrator : {"half_implicit", "rattle"}) {
    SCOPED_TRACE(integrator);
    const Settings settings = usual(integrator, GetParam(), 1e-2, 0.2);
    const Recorded doubted = run(scene, settings);
    EXPECT_THAT(doubted.outcome.notices, grows);
    EXPECT_GT(farthest(doubted), 1);
    for (const Settings& remedy : {changed(settings, [](Settings& s) { s.integrator = "radau5"; }),
                                   changed(settings, [](Settings& s) { s.integrator = "generalized_alpha"; }),
                                   changed(settings, [](Settings& s) { s.step = 1e-3; })}) {
      const Recorded r = run(scene, remedy);
      EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_THAT(r.outcome.notices, Not(grows));
      EXPECT_LT(farthest(r), 0.0121) << remedy.integrator;  // from 0.01; forces at the start of a step: by h w/2
    }
  }
}

TEST_P(Remedies, OfWhatRings) {
  const Scene scene = stiff_bob(1e4, 1e4);
  const auto rings = Contains(HasSubstr("try integrator radau5 or a step that resolves it"));
  for (const char* integrator : {"generalized_alpha", "generalized_alpha_i2"}) {
    SCOPED_TRACE(integrator);
    const Settings settings = usual(integrator, GetParam(), 1e-2, 0.2);
    EXPECT_THAT(run(scene, settings).outcome.notices, rings);
    for (const Settings& remedy : {changed(settings, [](Settings& s) { s.integrator = "radau5"; }),
                                   changed(settings, [](Settings& s) { s.step = 1e-4; })}) {
      const Recorded r = run(scene, remedy);
      EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      EXPECT_THAT(r.outcome.notices, Not(rings));
      EXPECT_NEAR(r.samples.back().bodies[0].r.x() - 0.99, 0.01 * std::exp(-0.2), 1e-4);
    }
  }
}

TEST_P(Remedies, OfARowSetAsideThatIsLost) {
  const char* const remedy = "one of them has to go, or the steps leave them; try smaller steps or a smaller tolerance";
  const char* const of_tolerance = "the tolerance of Newton's method leaves those off by up to";
  const Scene loose = loop({4, Frames::random, true, true});
  int lost = 0;
  for (const char* integrator : kFixedMethods) {
    SCOPED_TRACE(integrator);
    Settings settings = usual(integrator, GetParam(), 0.02, 0.8);
    settings.tolerance = 0.1;
    const Recorded r = run(loose, settings);
    if (r.outcome.status.failure == Failure::constraint_lost) {
      ++lost;
      expect_stopped(r, Failure::constraint_lost, "joint 'joint", of_tolerance);
      EXPECT_EQ(remedy_of(r), "; try smaller steps or a smaller tolerance");
      expect_helped(loose, changed(settings, [](Settings& s) { s.tolerance = 1e-6; }));
      expect_helped(loose, changed(settings, [](Settings& s) { s.step = 2e-3; }));
    }
    settings = usual(integrator, GetParam(), 1e-3, 1);
    expect_stopped(run(twice_driven("t", "t + t^5"), settings), Failure::constraint_lost, "driver 't", remedy);
    Scene one = twice_driven("t", "t + t^5");
    one.drivers.pop_back();
    expect_helped(one, settings);
  }
  EXPECT_GE(lost, 1);
}

// A rotation notice names a step that loses less than what it warns of.
TEST_P(Remedies, OfRotationThatIsLost) {
  Scene scene;
  Body& body = scene.bodies.emplace_back();
  body.name = "body", body.mass = 1, body.inertia = Vector3(1, 2, 3).asDiagonal();
  body.angular_velocity = Vector3(0.3, 0.9, 0.3).normalized();
  for (const char* integrator : kFixedMethods) {
    SCOPED_TRACE(integrator);
    const double end = 2 * std::numbers::pi;
    const Rotations& limits = integrators().require(integrator).rotations;
    const double wrong = limits.in(formulations().require(GetParam()).space).wrong;
    Settings settings = with_step(usual(integrator, GetParam(), 1, end), 1.3 * wrong);
    const Recorded told = run(scene, settings);
    if (!told.outcome.status.ok()) continue;  // beyond what makes sense
    ASSERT_THAT(told.outcome.notices, Contains(HasSubstr("of a free body's rotation")));
    std::smatch step;
    ASSERT_TRUE(std::regex_search(told.outcome.notices.back(), step, std::regex("a step below ([0-9.e+-]+) s")));
    const Recorded r = run(scene, with_step(settings, std::stod(step[1])));
    ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
    EXPECT_THAT(r.outcome.notices, ::testing::IsEmpty());
    const Vector3 w = r.samples.back().bodies[0].w;
    EXPECT_NEAR(
        std::sqrt(w.dot(scene.bodies[0].inertia * w) / body.angular_velocity.dot(body.inertia * body.angular_velocity)),
        1, 0.035);
  }
}

}  // namespace
}  // namespace poinsot::test
