// What starts in singular positions have at once: the velocities of a branch, accelerations and forces of the motion
// beside; and starts beside singular positions.
#include <functional>
#include <numbers>

#include "tests/support/loops.h"
#include "tests/support/passages.h"
#include "tests/support/singular_starts.h"

namespace poinsot::test {
namespace {

using StartsOnABranch = SingularStarts;
using std::numbers::pi;

INSTANTIATE_TEST_SUITE_P(All, StartsOnABranch, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// To first order each crank of a flat parallelogram may turn as it likes; only two of these ways lead on. Likewise a
// rod driven by the cosine of its angle, a press and a folded toggle.
TEST_P(StartsOnABranch, VelocitiesOnNoBranchAreRefusedByName) {
  std::vector<Start> starts;
  for (const double w : {0.0, -1.5, -2.999}) {
    Start start{fmt::format("posts, the other at {} rad/s", w), posts(1, 0, kSpin, false)};
    std::vector<Body>& bodies = start.scene.bodies;
    bodies[1].velocity = {0, w / 2, 0}, bodies[1].angular_velocity = {0, 0, w};
    bodies[2].velocity = {0, (w + kSpin) / 2, 0}, bodies[2].angular_velocity = {0, 0, w - kSpin};
    starts.push_back(std::move(start));
  }
  for (const double w : {0.5, 1.01, 2.0}) {
    const Way turning = [=](double t) { return std::vector<Planar>{{std::cos(w * t), std::sin(w * t), w * t}}; };
    Start cosine{fmt::format("cosine at {} rad/s", w), scene_on(turning, {0, -9.81, 0})};
    add_joint(cosine.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
    Constraint& row = add_constraint(cosine.scene, "cosine", ConstraintType::DP1, 0, "cos(t)");
    row.a_i = row.a_j = {1, 0, 0};
    cosine.kinematics = true;
    starts.push_back(std::move(cosine));

    Start press = toggle(fmt::format("press at {} rad/s", w), toggle_way([=](double t) { return w * t; }), {5, 0, 0});
    add_constraint(press.scene, "press", ConstraintType::CD, 2, "2*cos(t)").c = Vector3::UnitX();
    press.kinematics = true;
    press.way.reset();
    starts.push_back(std::move(press));
  }
  Start folded = toggle("folded", [](double t) { return crank_and_rod(pi / 2 + 2 * t, -pi / 2 - t); }, {1, -9.81, 0});
  folded.way.reset();
  starts.push_back(std::move(folded));
  expect_right_or_named(starts);
}

// Without accelerations what is left of them beside the position is rounding, and no jump.
TEST_P(StartsOnABranch, ARodThatTurnsAboutItsCentreKeepsTurning) {
  const Way way = [](double t) { return std::vector<Planar>{{0, 0, t}}; };
  Start start{"centred", scene_on(way, Vector3::Zero()), way};
  add_joint(start.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
  Constraint& cosine = add_constraint(start.scene, "cosine", ConstraintType::DP1, 0, "cos(t)");
  cosine.a_i = cosine.a_j = {1, 0, 0};
  start.kinematics = true;
  expect_right_or_named({start});
}

// Mechanisms whose angle is prescribed, phi0 + rate t, by constraints that are singular where it is 0: a press on a
// toggle, a rod turned by the cosine of its angle about a hinge at `arm`, the crank of a four-bar. They begin at the
// part `part` of that rate.
struct Prescribed {
  double phi0, rate, part;

  Start press(const Vector3& gravity) const {
    Start press = toggle("press", toggle_way(angle(part)), gravity);
    add_constraint(press.scene, "press", ConstraintType::CD, 2, fmt::format("2*cos({}*t + {})", rate, phi0)).c =
        Vector3::UnitX();
    return named(press, toggle_way(angle(1)));
  }
  Start rod(double arm) const {
    const auto way = [=](const auto& phi) {
      return [=](double t) { return std::vector<Planar>{{arm * std::cos(phi(t)), arm * std::sin(phi(t)), phi(t)}}; };
    };
    Start rod{fmt::format("rod of {} m", arm), scene_on(way(angle(part)), {0, -9.81, 0})};
    add_joint(rod.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
    Constraint& cosine =
        add_constraint(rod.scene, "cosine", ConstraintType::DP1, 0, fmt::format("cos({}*t + {})", rate, phi0));
    cosine.a_i = cosine.a_j = {1, 0, 0};
    return named(rod, way(angle(1)));
  }
  Start four_bar() const {
    const auto way = [](const auto& phi) { return [=](double t) { return parallelogram(phi(t), phi(t)); }; };
    Start crank{"four-bar", scene_on(way(angle(part)), {1, -9.81, 0})};
    const Vector3 tip(std::cos(phi0), std::sin(phi0), 0);
    add_joint(crank.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
    add_joint(crank.scene, "knee", JointType::cylindrical, 0, 1, tip);
    add_joint(crank.scene, "elbow", JointType::spherical, 1, 2, tip + 2 * Vector3::UnitX());
    add_joint(crank.scene, "foot", JointType::revolute, kGround, 2, {2, 0, 0});
    Driver& motor = crank.scene.drivers.emplace_back();
    motor.name = "motor", motor.j = 0, motor.axis = {0, 0, 1},
    motor.value = Expression::parse(fmt::format("{}*t", rate));
    return named(crank, way(angle(1)));
  }

 private:
  std::function<double(double)> angle(double of) const {
    return [=, *this](double t) { return of * rate * t + phi0; };
  }
  Start named(Start start, const Way& way) const {
    start.what += fmt::format(", {} rad + {} of {} rad/s", phi0, part, rate);
    start.way = way;
    return start;
  }
};

// Beside a singular position there is one way to go, and constraints hardly say which: velocities off it are put right
// or refused.
TEST_P(StartsOnABranch, VelocitiesBesideAreThoseOfTheBranchOrRefusedByName) {
  std::vector<Start> starts;
  for (const double beside : {1e-13, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4}) {
    for (const double rate : {0.01, 5.0}) {
      for (const double part : {1.0, 0.5, 0.0}) {
        const Prescribed p{beside, rate, part};
        for (Start start : {p.press({5, 0, 0}), p.rod(0), p.rod(1), p.four_bar()}) {
          start.kinematics = true;
          start.may_stop = part != 1;
          starts.push_back(std::move(start));
        }
      }
    }
  }
  expect_right_or_named(starts);
}

// Output times in the very position, on the way and at the end: multipliers are the limit of those beside, or it is
// said that there is none.
TEST_P(StartsOnABranch, WhatIsGivenOutInASingularPositionIsTheLimitOfWhatIsBeside) {
  std::vector<Start> starts;
  for (const double way : {0.5, 1.0}) {
    const Prescribed p{-way * kUntil, 1, 1};
    for (Start start : {p.press({5, 0, 0}), p.press({0, -9.81, 0}), p.rod(0), p.rod(1), p.four_bar()}) {
      start.may_stop = way == 1;
      starts.push_back(std::move(start));
    }
  }
  expect_right_or_named(starts);
}

// The constraints alone leave rates open: none is given out, and a constraint is named.
TEST_P(StartsOnABranch, KinematicsFromASingularPositionIsRefusedByName) {
  for (const double beside : {0.0, 1e-13, 1e-10, 1e-7}) {
    const Way way = toggle_way([=](double t) { return beside + t; });
    Start start = toggle(fmt::format("{} rad beside", beside), way, {5, 0, 0});
    add_constraint(start.scene, "press", ConstraintType::CD, 2, fmt::format("2*cos(t + {})", beside)).c =
        Vector3::UnitX();
    Settings settings = dynamics(GetParam(), kStride, kUntil, kUntil / 4);
    settings.analysis = Analysis::kinematics;
    settings.integrator = "kinematics";
    settings.tolerance = 1e-12;
    const Attempt c = attempt(start.scene, settings);
    EXPECT_TRUE(start.named_in(c.refusal)) << beside << ' ' << c.refusal;
    EXPECT_THAT(c.refusal, ::testing::HasSubstr("singular here: ")) << beside;
    EXPECT_TRUE(c.samples.empty()) << beside;
  }
}

// With gravity along it the press holds back with 3 cos φ + 2 g: bounded, unlike with gravity across.
TEST_P(StartsOnABranch, TheForceOfAPressOnAStraightToggleIsThatOfTheClosedForm) {
  const double g = 5;
  for (const double phi0 : {0.0, -kUntil / 2}) {
    const Start start = Prescribed{phi0, 1, 1}.press({g, 0, 0});
    for (const IntegratorEntry& integrator : integrators()) {
      if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
      SCOPED_TRACE(::testing::Message() << start.what << ", " << integrator.name);
      int seen = 0;
      std::optional<Reactions> reactions;
      const Outcome outcome = simulate(start.scene, settings_of(integrator), [&](const Sample& sample) {
        if (!reactions) reactions.emplace(sample.problem);
        reactions->update(sample);
        const Model& model = sample.problem.model();
        for (std::size_t k = 0; k < model.rows.size(); ++k) {
          if (model.groups[static_cast<std::size_t>(model.rows[k].group)].name != "press") continue;
          EXPECT_NEAR(reactions->lambda(static_cast<int>(k)), 3 * std::cos(phi0 + sample.t) + 2 * g, 0.05) << sample.t;
          ++seen;
        }
      });
      ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
      EXPECT_EQ(seen, 5);
      EXPECT_THAT(outcome.notices, ::testing::Not(::testing::Contains(::testing::HasSubstr("multipliers"))));
    }
  }
}

double largest_acceleration(const Snapshot& s) {
  double largest = 0;
  for (const BodyState& b : s.bodies) largest = std::max({largest, b.rdd.norm(), b.wd.norm()});
  return largest;
}

// Four-bars lying flat: what is given out there is of the size of what the same motion has 0.01 s before and after.
TEST_P(StartsOnABranch, FlatFourBarsHaveTheAccelerationsAndForcesOfThoseBeside) {
  constexpr double kBeside = 0.01;
  for (const int N : {1, 2}) {
    const Way way = posts_way(N, 0, kSpin);
    for (const bool redundant : {false, true}) {
      const Start flat{fmt::format("{} four-bars{}", N, redundant ? ", redundant" : ""), posts(N, 0, kSpin, redundant),
                       way, false, true};
      for (const IntegratorEntry& integrator : integrators()) {
        if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
        SCOPED_TRACE(::testing::Message() << flat.what << ", " << integrator.name);
        const Settings settings = settings_of(integrator, 4 * kBeside);
        const Attempt c = attempt(flat.scene, settings);
        ASSERT_TRUE(c.refusal.empty()) << c.refusal;
        expect_right(c, flat, integrator);
        // Of two, the middle post's share makes them grow without bound towards the position: the bound of ten times
        // is that of 0.01 s beside.
        if (N == 1) {
          EXPECT_LT(c.off[0], 1e-9);
        }
        for (const double beside : {-kBeside, kBeside}) {
          const Rates there = rates(way, beside)[0];
          const Attempt b =
              attempt(posts(N, there.at.angle, there.rate.angle, redundant), settings_of(integrator, kBeside / 2));
          ASSERT_TRUE(b.refusal.empty()) << b.refusal;
          for (const std::size_t k : {0u, 1u}) {
            EXPECT_NEAR(largest_acceleration(c.samples[k]) / largest_acceleration(b.samples[0]), 1, 0.2) << k;
            EXPECT_LT(c.force[k], 10 * b.force[0]) << k;
            EXPECT_GT(c.force[k], b.force[0] / 10) << k;
            EXPECT_LT(largest_multiplier(c.samples[k]), 10 * largest_multiplier(b.samples[0])) << k;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace poinsot::test
