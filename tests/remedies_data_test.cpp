// Runs that stop for what a scene asks of them, or for the linear solver they were given: what the stop says to try
// helps, in the same scene.
#include <gtest/gtest.h>

#include "tests/support/every_way.h"
#include "tests/support/loops.h"
#include "tests/support/remedies.h"
#include "tests/support/singular_starts.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class RemediesOfData : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, RemediesOfData, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// Calls visit(settings) for each integrator of dynamics that takes the formulation.
template <class Visit>
void by_every_method(const std::string& formulation, double step, double end, Visit&& visit) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, formulation)) continue;
    SCOPED_TRACE(integrator.name);
    Settings settings;
    settings.integrator = integrator.name, settings.formulation = formulation;
    settings.step = step, settings.end = end;
    visit(settings);
  }
}

Scene bob_pushed_by(const char* force) {
  Scene scene;
  Body& bob = scene.bodies.emplace_back();
  bob.name = "bob", bob.mass = 1, bob.inertia = Matrix3::Identity();
  PointForce push;
  push.name = "push", push.body = 0, push.force[0] = Expression::parse(force);
  scene.forces.emplace_back(push);
  return scene;
}

TEST_P(RemediesOfData, OfAFunctionWithoutAValueAreAnEndBeforeOrAnotherFunction) {
  by_every_method(GetParam(), 1e-2, 1, [&](Settings settings) {
    expect_stopped(run(bob_pushed_by("sqrt(0.505 - t)"), settings), Failure::not_finite, "force 'push'",
                   "end the run before, or change the function");
    expect_helped(bob_pushed_by("sqrt(max(0.505 - t, 0.005))"), settings);
    settings.end = 0.5;
    expect_helped(bob_pushed_by("sqrt(0.505 - t)"), settings);
  });
}

// There is no end before the start.
TEST_P(RemediesOfData, OfAFunctionWithoutAValueAtTheStartAreALaterBeginningOrAnotherFunction) {
  by_every_method(GetParam(), 1e-2, 0.1, [&](const Settings& settings) {
    for (const char* force : {"log(t)", "1/t"}) {
      const Recorded r = run(bob_pushed_by(force), settings);
      expect_stopped(r, Failure::not_finite, "force 'push'",
                     "the run begins there: change the function, or write (t + T) for t to begin at T");
      EXPECT_THAT(r.outcome.status.message, Not(HasSubstr("end the run before")));
      EXPECT_THAT(r.outcome.notices, ::testing::IsEmpty());  // that it is infinite is no matter of units
    }
    expect_helped(bob_pushed_by("log(t + 0.5)"), settings);
    expect_helped(bob_pushed_by("1/max(t, 1)"), settings);
  });
}

TEST_P(RemediesOfData, OfNumbersThatOverflowAreSmallerUnits) {
  Scene heavy = bob_pushed_by("0");
  heavy.gravity = {0, 0, -9.81};
  heavy.bodies[0].mass = 1e300;
  Scene light = heavy;
  light.bodies[0].mass = 1e100;
  by_every_method(GetParam(), 1e-2, 0.1, [&](const Settings& settings) {
    const Recorded r = run(heavy, settings);
    if (r.outcome.status.ok()) return;
    expect_stopped(r, Failure::not_finite, "body 'bob'", "give it in units in which it is smaller");
    expect_helped(light, settings);
  });
}

// A motion that grows without bound comes to numbers that no matrix is made of.
TEST_P(RemediesOfData, OfWhatHasGrownBeyondAllNumbersIsASmallerStep) {
  Scene scene = bob_pushed_by("0");
  scene.bodies[0].position = {1, 0, 0};
  Spring spring;
  spring.name = "spring", spring.i = kGround, spring.j = 0, spring.stiffness = 1e6, spring.length = 0.99;
  scene.forces.emplace_back(spring);
  Joint& guide = scene.joints.emplace_back();
  guide.name = "guide", guide.type = JointType::translational, guide.i = kGround, guide.j = 0, guide.axis = {1, 0, 0};
  for (const char* integrator : {"half_implicit", "rattle"}) {
    SCOPED_TRACE(integrator);
    Settings settings;
    settings.integrator = integrator, settings.formulation = GetParam();
    settings.step = 1e-2, settings.end = 4;
    const Recorded r = run(scene, settings);
    expect_stopped(r, Failure::not_finite, "body 'bob'", "try ");
    settings.step = 1e-3;
    expect_helped(scene, settings);
  }
}

// A slider whose distance, and a crank whose angle is prescribed.
Scene driven_slider(const char* length) {
  Scene scene = bob_pushed_by("0");
  scene.bodies[0].position = {1, 0, 0};
  Joint& guide = scene.joints.emplace_back();
  guide.name = "guide", guide.type = JointType::translational, guide.i = kGround, guide.j = 0, guide.axis = {1, 0, 0};
  Driver& driver = scene.drivers.emplace_back();
  driver.name = "length", driver.type = DriverType::distance, driver.i = kGround, driver.j = 0;
  driver.value = Expression::parse(length);
  return scene;
}

Scene driven_crank(const char* angle) {
  Scene scene = posts(1, 0.5, 0, false);
  Driver& motor = scene.drivers.emplace_back();
  motor.name = "motor", motor.i = kGround, motor.j = 0, motor.axis = {0, 0, 1};
  motor.value = Expression::parse(angle);
  return scene;
}

TEST_P(RemediesOfData, OfALengthBelowZeroIsAnotherFunction) {
  by_every_method(GetParam(), 1e-2, 0.1, [&](const Settings& settings) {
    expect_stopped(run(driven_slider("-1 - t"), settings), Failure::not_finite, "driver 'length'",
                   "is -1 m, expected a positive one; the run begins there: change the function, or write (t + T)");
    expect_helped(driven_slider("1 + t"), settings);
  });
}

// Kinematics integrates nothing: there it is what a driver asks for that comes to numbers that no matrix is made of.
TEST_P(RemediesOfData, OfKinematicsThatAsksForTooMuchAreAnEndBeforeOrAnotherFunction) {
  Settings settings;
  settings.analysis = Analysis::kinematics, settings.formulation = GetParam();
  const Recorded r = run(driven_slider("exp(800*t)"), settings);
  expect_stopped(r, Failure::not_finite, "a driver asks for more, or for it faster, than numbers can hold",
                 "end the run before, or change the function");
  EXPECT_THAT(r.outcome.status.message, Not(HasSubstr("moves at")));
  EXPECT_NEAR(r.outcome.status.time, 0.434, 0.1);
  expect_helped(driven_slider("exp(8*t)"), settings);
  settings.end = 0.1;
  expect_helped(driven_slider("exp(800*t)"), settings);
}

TEST_P(RemediesOfData, OfAPositionThatJumpsNameWhatJumps) {
  by_every_method(GetParam(), 1e-2, 1, [&](const Settings& settings) {
    const Recorded r = run(driven_crank("0.1*t + 0.2*step(t - 0.5)"), settings);
    expect_stopped(r, Failure::inconsistent_state, "driver 'motor'", "a jump of positions, which no motion follows");
    EXPECT_EQ(remedy_of(r), "; let it pass through the values between");
    expect_helped(driven_crank("0.1*t + 0.2*min(max(10*(t - 0.5), 0), 1)"), settings);
  });
}

TEST_P(RemediesOfData, OfALinearSolverThatRefusesIsAnotherOne) {
  Scene scene;
  for (int k = 0; k < 350; ++k) {  // free ones, whose steps cost next to nothing otherwise
    Body& body = scene.bodies.emplace_back();
    body.name = fmt::format("body{}", k), body.mass = 1, body.inertia = Matrix3::Identity(), body.position.x() = 2 * k;
  }
  Settings settings;
  settings.formulation = GetParam(), settings.integrator = "rattle";
  settings.step = 1e-2, settings.end = 1e-2;
  settings.linear_solver = "dense";
  expect_stopped(run(scene, settings), Failure::refused, "at most 2000 unknowns, these are 2",
                 "try another one, as auto");
  settings.linear_solver = "auto";
  expect_helped(scene, settings);
}

// A press that asks for more than its toggle reaches. Where nothing can be made of IDA's own motion any more it is the
// steps of dop853 that say so.
TEST(RemediesOfIda, WhereADriverAsksForTooMuchAreToEndBefore) {
  const double phi = 0.1;
  Start press = toggle("press", toggle_way([=](double t) { return phi - 0.01 / std::sin(phi) * t; }), {5, -9.81, 0});
  add_constraint(press.scene, "press", ConstraintType::CD, 2, "2*cos(0.1) + 0.02*t").c = Vector3::UnitX();
  Settings settings = controlled("ida", "rp", 1e-5, 1.3, 0.05);
  const Recorded r = run(press.scene, settings);
  ASSERT_FALSE(r.outcome.status.ok());
  EXPECT_NEAR(r.outcome.status.time, (2 - 2 * std::cos(phi)) / 0.02, 1e-3);
  EXPECT_THAT(r.outcome.status.message, HasSubstr("joint '"));
  EXPECT_THAT(r.outcome.status.message, HasSubstr("end before it"));
  settings.end = 0.45;
  expect_helped(press.scene, settings);
}

// A cosine that is prescribed does not say to which side its directions turn once they lie in a line.
TEST(RemediesOfACosine, WhoseGradientVanishesIsAnAngleDriver) {
  Scene cosine;
  Body& rod = cosine.bodies.emplace_back();
  rod.name = "rod", rod.mass = 1, rod.inertia = Vector3(0.02, 0.1, 0.1).asDiagonal();
  rod.orientation = Eigen::AngleAxisd(1, Vector3::UnitZ()).toRotationMatrix(), rod.angular_velocity = {0, 0, -3};
  Joint& hinge = cosine.joints.emplace_back();
  hinge.name = "hinge", hinge.i = kGround, hinge.j = 0, hinge.axis = {0, 0, 1};
  Scene angle = cosine;
  Constraint& row = cosine.constraints.emplace_back();
  row.name = "cosine", row.type = ConstraintType::DP1, row.i = kGround, row.j = 0;
  row.a_i = row.a_j = {1, 0, 0}, row.f = Expression::parse("cos((1 - t)^3)");
  Driver& motor = angle.drivers.emplace_back();
  motor.name = "motor", motor.i = kGround, motor.j = 0, motor.axis = {0, 0, 1};
  motor.value = Expression::parse("(1 - t)^3 - 1");
  int stopped = 0;
  for (const auto& [integrator, formulation] : {std::pair("dopri5", "rA"), {"dop853", "rA"}, {"dop853", "rp"}}) {
    SCOPED_TRACE(fmt::format("{} {}", integrator, formulation));
    const Settings settings = controlled(integrator, formulation, 1e-8, 1.3, 0.05);
    const Recorded r = run(cosine, settings);
    if (r.outcome.status.ok()) continue;
    ++stopped;
    EXPECT_THAT(r.outcome.status.message,
                HasSubstr("the directions of constraint 'cosine' (/constraints/0) have come to"));
    EXPECT_THAT(r.outcome.status.message, HasSubstr("an angle driver in its place does"));
    EXPECT_NEAR(r.outcome.status.time, 1, 1e-2);
    expect_helped(angle, settings);
    EXPECT_NEAR(run(angle, settings).samples.back().bodies[0].A(1, 0), std::sin(std::pow(-0.3, 3)), 1e-6);
  }
  EXPECT_GT(stopped, 0);
}

}  // namespace
}  // namespace poinsot::test
