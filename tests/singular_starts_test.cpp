// Mechanisms that start in singular positions: whatever the formulation and the integrator, a run that ends is right,
// and one that is refused or stops names a constraint that is singular there.
#include "tests/support/singular_starts.h"

#include <numbers>

#include "tests/support/loops.h"
#include "tests/support/passages.h"

namespace poinsot::test {
namespace {

using std::numbers::pi;

INSTANTIATE_TEST_SUITE_P(All, SingularStarts, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// With a free slider the straight position is a regular one: what the same toggle does once it is driven is due to
// that.
TEST_P(SingularStarts, AStraightToggleWithAFreeSliderMovesAsOneCoordinate) {
  std::vector<Start> starts;
  for (const double w : {0.0, 2.0}) {
    for (const Vector3& g : {Vector3(-5, 0, 0), Vector3(1, -9.81, 0)}) {
      const auto acceleration = [=](double phi, double rate) { return toggle_acceleration(phi, rate, g); };
      const Way way = toggle_way([=](double t) { return turned(t, 0, w, acceleration); });
      starts.push_back(toggle(fmt::format("toggle at {} rad/s, gravity {} {}", w, g.x(), g.y()), way, g));
      starts.back().conserves = true;
    }
  }
  expect_right_or_named(starts);
}

// The slider of a straight toggle is driven, from rest: the knee goes up or down, as the velocities say. At rest there
// are two ways to go, or none, and none either for a law that begins with a velocity or stays where it is, but to rest
// where no load is across.
TEST_P(SingularStarts, AStraightToggleThatIsDrivenGoesWhereItsVelocitiesLead) {
  std::vector<Start> starts;
  for (const Vector3& g : {Vector3(5, 0, 0), Vector3(0, -9.81, 0)}) {
    for (const double w : {1.0, -1.0, 0.0}) {
      for (const char* law : {"2*cos(t)", "2 - t^2", "2 - t^4", "2 - t", "2"}) {
        const bool cosine = law == std::string("2*cos(t)"), leads = cosine || law == std::string("2 - t^2");
        const Way way = toggle_way([=](double t) { return w * (cosine ? t : 2 * std::asin(t / 2)); });
        Start start = toggle(fmt::format("press {} at {} rad/s, gravity {} {}", law, w, g.x(), g.y()), way, g);
        add_constraint(start.scene, "press", ConstraintType::CD, 2, law).c = Vector3::UnitX();
        start.kinematics = true;
        const bool rests = w == 0 && law == std::string("2") && g.y() == 0;
        if ((w == 0 || !leads) && !rests) start.way.reset();
        start.may_stop = rests;  // in kinematics
        starts.push_back(std::move(start));
      }
    }
  }
  expect_right_or_named(starts);
}

// Two links in line between two pivots, which cannot move at all, though to first order the knee can.
TEST_P(SingularStarts, AStraightToggleHeldAtBothEndsDoesNotMove) {
  std::vector<Start> starts;
  for (const bool redundant : {false, true}) {
    for (const Vector3& g : {Vector3(0, 0, 0), Vector3(5, 0, 0), Vector3(0, -9.81, 0)}) {
      for (const double w : {0.0, 1.0}) {
        const Way way = [=](double t) {
          return std::vector<Planar>{{0.5, w * t / 2, w * t}, {1.5, w * t / 2, -w * t}};
        };
        Start start{fmt::format("held at {} rad/s, gravity {} {}, {}", w, g.x(), g.y(), redundant), scene_on(way, g)};
        add_joint(start.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
        add_joint(start.scene, "knee", redundant ? JointType::revolute : JointType::cylindrical, 0, 1, {1, 0, 0});
        add_joint(start.scene, "foot", redundant ? JointType::revolute : JointType::spherical, kGround, 1, {2, 0, 0});
        start.kinematics = true;
        start.may_stop = true;
        if (w == 0 && g.y() == 0) start.way = way;  // no force holds it against a load across
        starts.push_back(std::move(start));
      }
    }
  }
  expect_right_or_named(starts);
}

// Crank and rod one upon the other, the slider at the crank's hinge: it slides on, or stays while both turn on.
TEST_P(SingularStarts, AFoldedToggleSlidesOrTurnsAsItsVelocitiesLead) {
  std::vector<Start> starts;
  const Vector3 g(1, -9.81, 0);
  const auto slides = [=](double phi, double w) { return toggle_acceleration(phi, w, g); };
  const auto turns = [=](double phi, double) { return (g.y() * std::cos(phi) - g.x() * std::sin(phi)) / 0.7; };
  for (const double w : {3.0, -3.0, 0.0}) {
    const Way sliding = toggle_way([=](double t) { return turned(t, pi / 2, w, slides); });
    const Way turning = [=](double t) {
      const double phi = turned(t, pi / 2, w, turns);
      return crank_and_rod(phi, phi + pi);
    };
    starts.push_back(toggle(fmt::format("sliding at {} rad/s", w), sliding, g));
    starts.push_back(toggle(fmt::format("turning at {} rad/s", w), turning, g));
  }
  for (Start& start : starts) start.conserves = true;
  for (std::size_t k = starts.size() - 2; k < starts.size(); ++k) starts[k].way.reset();
  expect_right_or_named(starts);
}

// Flat, with its crank driven: as a parallelogram, ψ = φ, or crossed, tan ψ/2 = −3 tan φ/2.
TEST_P(SingularStarts, AFlatParallelogramThatIsDrivenStaysParallelOrCrosses) {
  std::vector<Start> starts;
  for (const bool redundant : {false, true}) {
    for (const char* law : {"t", "sin(t)", "t^2", "0"}) {
      const bool moves = law != std::string("t^2") && law != std::string("0");
      for (const bool crossed : {false, true}) {
        if (crossed && !moves) continue;
        const Way way = [=](double t) {
          const double phi = !moves ? 0 : law[0] == 's' ? std::sin(t) : t;
          return parallelogram(phi, crossed ? -2 * std::atan(3 * std::tan(phi / 2)) : phi);
        };
        Start start{fmt::format("motor {}{}{}", law, crossed ? ", crossed" : "", redundant ? ", redundant" : ""),
                    scene_on(way, {1, -9.81, 0})};
        Scene& scene = start.scene;
        add_joint(scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
        add_joint(scene, "knee", redundant ? JointType::revolute : JointType::cylindrical, 0, 1, {1, 0, 0});
        add_joint(scene, "elbow", redundant ? JointType::revolute : JointType::spherical, 1, 2, {3, 0, 0});
        add_joint(scene, "foot", JointType::revolute, kGround, 2, {2, 0, 0});
        Driver& motor = scene.drivers.emplace_back();
        motor.name = "motor", motor.j = 0, motor.axis = {0, 0, 1}, motor.value = Expression::parse(law);
        start.kinematics = true;
        if (moves) start.way = way;
        starts.push_back(std::move(start));
      }
    }
  }
  expect_right_or_named(starts);
}

// A rod turned by the cosine of its angle from 0 on: at ±1 rad/s it turns on, at rest it has nowhere to go. A cosine
// that stays 1 holds it, one of 1 − t⁴ turns it from rest, either way: both are refused.
TEST_P(SingularStarts, ADirectionDrivenFromOneTurnsAsItsVelocityLeads) {
  std::vector<Start> starts;
  for (const char* law : {"cos(t)", "1", "1 - t^4"}) {
    for (const double w : {1.0, -1.0, 0.0}) {
      for (const bool helped : {false, true}) {
        const bool leads = law == std::string("cos(t)") && w != 0;
        if (helped && !leads) continue;
        const Way way = [=](double t) { return std::vector<Planar>{{std::cos(w * t), std::sin(w * t), w * t}}; };
        Start start{fmt::format("cosine {} at {} rad/s{}", law, w, helped ? ", helped" : ""),
                    scene_on(way, {0, -9.81, 0})};
        add_joint(start.scene, "hinge", JointType::revolute, kGround, 0, Vector3::Zero());
        Constraint& cosine = add_constraint(start.scene, "cosine", ConstraintType::DP1, 0, law);
        cosine.a_i = cosine.a_j = {1, 0, 0};
        if (helped) cosine.alternate = {{0, 1, 0}, {1, 0, 0}, Expression::parse(fmt::format("sin({}*t)", w))};
        start.kinematics = true;
        if (leads) start.way = way;
        starts.push_back(std::move(start));
      }
    }
  }
  expect_right_or_named(starts);
}

// A distance of 0 says nothing of the way in which it grows; velocities do.
TEST_P(SingularStarts, ADistanceDrivenFromZeroIsRightOrRefusedByName) {
  std::vector<Start> starts;
  for (const bool driver : {false, true}) {
    for (const bool guided : {false, true}) {
      for (const char* law : {"t", "sin(t)", "t^2", "0"}) {
        for (const double v : {1.0, -1.0, 0.0}) {
          const bool sine = law[0] == 's', leads = v != 0 && (sine || law == std::string("t"));
          const Way way = [=](double t) { return std::vector<Planar>{{v * (sine ? std::sin(t) : t), 0, 0}}; };
          Start start{
              fmt::format("{} {} at {} m/s{}", driver ? "driver" : "distance", law, v, guided ? ", guided" : ""),
              scene_on(way, {guided ? 1.0 : 0.0, 0, 0})};
          if (guided)
            add_joint(start.scene, "guide", JointType::translational, kGround, 0, Vector3::Zero(), Vector3::UnitX());
          if (driver) {
            Driver& leg = start.scene.drivers.emplace_back();
            leg.name = "leg", leg.type = DriverType::distance, leg.j = 0, leg.value = Expression::parse(law);
          } else {
            add_constraint(start.scene, "leg", ConstraintType::D, 0, fmt::format("({})^2", law));
          }
          start.kinematics = guided;
          start.may_stop = driver;  // of no length where it begins
          if (leads) start.way = way;
          starts.push_back(std::move(start));
        }
      }
    }
  }
  expect_right_or_named(starts);
}

}  // namespace
}  // namespace poinsot::test
