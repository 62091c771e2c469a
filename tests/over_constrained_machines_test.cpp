// Machines that constrain too often, carried through space: grippers, legs, loops of up to eight links, several loops
// on one body and driven ones. Every formulation, integrator and linear solver moves them as without redundancy.
#include <gmock/gmock.h>

#include "tests/support/carried.h"
#include "tests/support/course.h"
#include "tests/support/loops.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// By the largest difference of a body's position, orientation or velocity at any of the same instants.
double motions_apart(const Course& a, const Course& b) {
  if (a.samples.size() != b.samples.size() || a.samples.empty()) return INFINITY;
  double largest = 0;
  for (std::size_t n = 0; n < a.samples.size(); ++n) {
    for (std::size_t k = 0; k < a.samples[n].bodies.size(); ++k) {
      const BodyState &x = a.samples[n].bodies[k], &y = b.samples[n].bodies[k];
      for (const double d :
           {(x.r - y.r).norm(), (x.A - y.A).norm(), (x.rd - y.rd).norm(), (x.A * x.w - y.A * y.w).norm()})
        largest = d <= largest ? largest : std::isnan(d) ? INFINITY : d;
    }
  }
  return largest;
}

// By how much the distance of two bodies changes from the start to the end.
double moved(const Course& course, std::size_t i, std::size_t j) {
  const auto distance = [&](const Snapshot& s) { return (s.bodies.at(i).r - s.bodies.at(j).r).norm(); };
  return course.samples.empty() ? 0 : std::abs(distance(course.samples.back()) - distance(course.samples.front()));
}

// Rods on hinges, all of them moving as one rigid body at the start.
class Machine {
 public:
  Machine(std::string name, Frames frames, bool redundant) : frames_(frames), redundant_(redundant) {
    scene_.name = std::move(name);
    scene_.gravity = {1, -9.81, -2};
  }

  // Of the same inertia however its frame lies.
  int rod(std::string name, double mass, const Vector3& from, const Vector3& to) {
    Body& body = scene_.bodies.emplace_back();
    body.name = std::move(name);
    body.mass = mass;
    body.position = 0.5 * (from + to);
    body.orientation = frame(frames_, static_cast<int>(scene_.bodies.size()));
    const Vector3 way = to - from;
    const Matrix3 J =
        mass * ((way.squaredNorm() / 12 + 1e-3) * Matrix3::Identity() - way * way.transpose() / 12);  // global
    body.inertia = body.orientation.transpose() * J * body.orientation;
    body.inertia = (0.5 * (body.inertia + body.inertia.transpose())).eval();
    return static_cast<int>(scene_.bodies.size()) - 1;
  }

  void hinge(int i, int j, const Vector3& point, const Vector3& axis) { join(JointType::revolute, i, j, point, axis); }

  // A hinge, or what has to stand in its place where rows are not to be redundant.
  void hinge_or(JointType type, int i, int j, const Vector3& point, const Vector3& axis) {
    join(redundant_ ? JointType::revolute : type, i, j, point, axis);
  }

  void spring(int i, int j, const Vector3& axis, double stiffness, double angle) {
    TorsionSpring s;
    s.name = fmt::format("spring{}", scene_.forces.size() + 1);
    s.i = i, s.j = j;
    s.axis = scene_.bodies[static_cast<std::size_t>(i)].orientation.transpose() * axis;
    s.stiffness = stiffness, s.damping = 0.01 * stiffness;
    s.angle = angle;
    scene_.forces.emplace_back(std::move(s));
  }

  Scene turning(const Vector3& w) {
    for (Body& body : scene_.bodies) {
      body.velocity = w.cross(body.position);
      body.angular_velocity = body.orientation.transpose() * w;
    }
    return scene_;
  }

 private:
  void join(JointType type, int i, int j, const Vector3& point, const Vector3& axis) {
    Joint& x = scene_.joints.emplace_back();
    x.name = fmt::format("joint{}", scene_.joints.size());
    x.type = type;
    x.i = i, x.j = j;
    x.point = point;
    x.axis = axis;
  }

  Scene scene_;
  Frames frames_;
  bool redundant_;
};

// What carries the mechanism: on a hinge to the ground, or free in space.
enum class Base { hinged, free };

constexpr std::size_t kUpperJaw = 4, kLowerJaw = 7;

// An arm, a palm that rolls at its end, two jaws on parallelograms of two links each, whose hinges are across the palm.
Scene gripper(Base base, Frames frames, bool redundant) {
  Machine made("gripper", frames, redundant);
  const Vector3 wrist(1, 0, 0), x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  const int arm = made.rod("arm", 4, Vector3::Zero(), wrist), palm = made.rod("palm", 2, wrist, wrist + 0.3 * x);
  if (base == Base::hinged) made.hinge(kGround, arm, Vector3::Zero(), y);
  made.hinge(arm, palm, wrist, x);
  made.spring(arm, palm, x, 3, 0.5);
  for (const double side : {1.0, -1.0}) {
    const Vector3 back = wrist + Vector3(0.1, 0.08 * side, 0), front = wrist + Vector3(0.25, 0.1 * side, 0),
                  link(0.08, 0.3 * side, 0), tip(0.25, 0, 0);
    const char* name = side > 0 ? "upper" : "lower";
    const int first = made.rod(fmt::format("{} back link", name), 0.4, back, back + link),
              second = made.rod(fmt::format("{} front link", name), 0.4, front, front + link),
              jaw = made.rod(fmt::format("{} jaw", name), 0.8, back + link, front + link + tip);
    made.hinge(palm, first, back, z);
    made.hinge(palm, second, front, z);
    made.hinge_or(JointType::spherical, first, jaw, back + link, z);
    made.hinge_or(JointType::cylindrical, second, jaw, front + link, z);
    made.spring(palm, first, z, 40, -0.3 * side);  // the jaws close, and stay off where a parallelogram is flat
  }
  return made.turning(base == Base::hinged ? Vector3(0, 6, 0) : Vector3(3, 5, -2));
}

constexpr std::size_t kHip = 0, kFoot = 4;

// A hip, from which a thigh and a rod nearly parallel to it lead to the shank, and a foot on the shank's ankle; with a
// tendon from the thigh to the heel a second loop that leans on the first one.
Scene leg(Base base, Frames frames, bool tendon, bool redundant) {
  Machine made("leg", frames, redundant);
  const Vector3 hip(0.1, -0.1, 0), behind(0.25, -0.05, 0), knee(0.25, -0.6, 0), bracket(0.4, -0.52, 0),
      ankle(0.15, -1.1, 0), toe(0.4, -1.15, 0), heel(0.05, -1.05, 0), calf(0.15, -0.5, 0), z = Vector3::UnitZ();
  const int body = made.rod("hip", 6, Vector3(0, 0.2, 0), Vector3(0.2, 0, 0.1));
  if (base == Base::hinged) made.hinge(kGround, body, Vector3::Zero(), Vector3::UnitY());
  const int thigh = made.rod("thigh", 3, hip, knee), rod = made.rod("rod", 0.5, behind, bracket),
            shank = made.rod("shank", 2, knee, ankle), foot = made.rod("foot", 0.6, heel, toe);
  made.hinge(body, thigh, hip, z);
  made.hinge(body, rod, behind, z);
  made.hinge_or(JointType::spherical, thigh, shank, knee, z);
  made.hinge_or(JointType::cylindrical, rod, shank, bracket, z);
  made.hinge(shank, foot, ankle, z);
  if (tendon) {
    const int band = made.rod("tendon", 0.3, calf, heel);
    made.hinge_or(JointType::spherical, thigh, band, calf, z);
    made.hinge_or(JointType::cylindrical, band, foot, heel, z);
  } else {
    made.spring(shank, foot, z, 5, 0.3);
  }
  made.spring(body, thigh, z, 60, 0.4);
  return made.turning(base == Base::hinged ? Vector3(0, 6, 0) : Vector3(3, 5, 2));
}

// Settings of every integrator of dynamics that takes the formulation.
template <class F>
void each_integrator(const std::string& formulation, double end, const F& f) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, formulation)) continue;
    Settings settings = dynamics(formulation, 2e-3, end, end);
    settings.integrator = integrator.name;
    settings.tolerance = 1e-8;
    settings.rtol = 1e-8;
    f(integrator, settings);
  }
}

// Fixed steps: the same solution of the same equations, but for what generalized-alpha has to begin anew where rows are
// exchanged, which costs of order step² and less than its own error. Error control: the tolerance, grown over the
// motion.
double allowed_apart(const IntegratorEntry& integrator, int exchanges) {
  if (integrator.controls_error) return integrator.name == "ida" ? 5e-6 : 1e-6;
  if (!integrator.name.starts_with("generalized_alpha")) return 1e-7;
  return exchanges == 0 ? 1e-6 : integrator.name == "generalized_alpha" ? 1e-4 : 2e-3;
}

struct Compared {
  Course with, without;
};

Compared compare(const IntegratorEntry& integrator, const Settings& settings, const Scene& with, const Scene& without) {
  Compared pair{move(with, settings), move(without, settings)};
  const Statistics &a = pair.with.outcome.statistics, &b = pair.without.outcome.statistics;
  EXPECT_TRUE(pair.with.outcome.status.ok()) << pair.with.outcome.status.message;
  EXPECT_TRUE(pair.without.outcome.status.ok()) << pair.without.outcome.status.message;
  EXPECT_LT(motions_apart(pair.with, pair.without), allowed_apart(integrator, pair.with.exchanges));
  EXPECT_EQ(pair.without.exchanges, 0);
  EXPECT_LT(a.violation.position, 1e-8);
  // IDA, whose order moves up and down by little, rejects some steps more and takes fewer.
  if (integrator.name == "ida") {
    EXPECT_LT(a.steps + a.rejected_steps, 1.5 * static_cast<double>(b.steps + b.rejected_steps));
  } else if (integrator.controls_error) {
    EXPECT_LE(a.rejected_steps, b.rejected_steps + 1);
  }
  return pair;
}

class Machines : public ::testing::TestWithParam<std::string> {};

TEST_P(Machines, GrippersMoveAsWithoutRedundancy) {
  int compared = 0;
  each_integrator(GetParam(), 1, [&](const IntegratorEntry& integrator, const Settings& settings) {
    for (const auto& [base, frames] : {std::pair(Base::hinged, Frames::quarter_turns), {Base::free, Frames::random}}) {
      SCOPED_TRACE(fmt::format("{} {} {}", integrator.name, GetParam(), base == Base::free ? "free" : "hinged"));
      const Compared pair = compare(integrator, settings, gripper(base, frames, true), gripper(base, frames, false));
      EXPECT_GT(moved(pair.with, kUpperJaw, kLowerJaw), 0.02);
      EXPECT_GT(pair.with.exchanges, 0);
      ++compared;
    }
  });
  EXPECT_GE(compared, 16);
}

TEST_P(Machines, LegsMoveAsWithoutRedundancy) {
  int compared = 0;
  each_integrator(GetParam(), 1, [&](const IntegratorEntry& integrator, const Settings& settings) {
    for (const Base base : {Base::hinged, Base::free}) {
      for (const bool tendon : {false, true}) {
        const Frames frames = tendon ? Frames::random : Frames::quarter_turns;
        SCOPED_TRACE(fmt::format("{} {} {}{}", integrator.name, GetParam(), base == Base::free ? "free" : "hinged",
                                 tendon ? ", with a tendon" : ""));
        const Compared pair =
            compare(integrator, settings, leg(base, frames, tendon, true), leg(base, frames, tendon, false));
        EXPECT_GT(moved(pair.with, kHip, kFoot), 0.02);
        EXPECT_GT(pair.with.exchanges, 0);
        ++compared;
      }
    }
  });
  EXPECT_GE(compared, 32);
}

// In so short a time a hinge axis turns by more than a right angle.
Scene faster(Scene scene) {
  for (Body& body : scene.bodies) body.velocity *= 3, body.angular_velocity *= 3;
  return scene;
}

TEST_P(Machines, LoopsOfFiveToEightLinksMoveAsWithoutRedundancy) {
  int compared = 0;
  each_integrator(GetParam(), 0.3, [&](const IntegratorEntry& integrator, const Settings& settings) {
    for (const int links : {5, 6, 7, 8}) {
      for (const bool carried : {false, true}) {
        const Frames frames = (links % 2 == 0) == carried ? Frames::quarter_turns : Frames::random;
        SCOPED_TRACE(fmt::format("{} {} {} links{}", integrator.name, GetParam(), links, carried ? ", carried" : ""));
        const Compared pair = compare(integrator, settings, faster(loop({links, frames, carried, true})),
                                      faster(loop({links, frames, carried, false})));
        EXPECT_EQ(pair.with.exchanges > 0, carried);
        ++compared;
      }
    }
  });
  EXPECT_GE(compared, 64);
}

TEST_P(Machines, SeveralLoopsOnOneBodyMoveAsWithoutRedundancy) {
  int compared = 0;
  each_integrator(GetParam(), 1, [&](const IntegratorEntry& integrator, const Settings& settings) {
    SCOPED_TRACE(fmt::format("{} {}", integrator.name, GetParam()));
    const Compared pair = compare(integrator, settings, Carried::four_bars(3, true), Carried::four_bars(3, false));
    EXPECT_GT(pair.with.exchanges, 0);
    ++compared;
  });
  EXPECT_GE(compared, 8);
}

// Redundant rows are out of the matrix, whichever are chosen: none is singular.
TEST_P(Machines, EveryLinearSolverMovesACarriedFourBarAlike) {
  const Scene with = loop({4, Frames::random, true, true}), without = loop({4, Frames::random, true, false});
  for (const char* integrator : {"implicit_euler", "dop853"}) {
    Settings settings = dynamics(GetParam(), 2e-3, 1, 1);
    settings.integrator = integrator;
    settings.tolerance = 1e-8;
    settings.rtol = 1e-10;
    settings.linear_solver = "dense";
    const Course reference = move(without, settings);
    ASSERT_TRUE(reference.outcome.status.ok()) << reference.outcome.status.message;
    for (const LinearSolverEntry& solver : linear_solvers()) {
      SCOPED_TRACE(fmt::format("{} {} {}", integrator, GetParam(), solver.name));
      settings.linear_solver = solver.name;
      const Course course = move(with, settings);
      ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
      EXPECT_LT(motions_apart(course, reference), 1e-7);
      EXPECT_GT(course.exchanges, 0);
      const std::vector<LinearWork>& works = course.outcome.statistics.linear;
      ASSERT_FALSE(works.empty());
      if (solver.name != "auto") {  // which picks one of the others
        EXPECT_EQ(works.front().solver, solver.name);
      }
    }
  }
}

const Vector3 kSkew(0.4, 1, 0.5);
constexpr const char* kDrivenTurn = "1.5*t";

// A four-bar of revolutes whose crank swings, alone or on a body that turns about an axis skew to the hinges.
Scene driven_four_bar(Frames frames, bool carried, bool redundant) {
  Scene scene = loop({4, frames, carried, redundant});
  for (Body& body : scene.bodies) body.velocity.setZero(), body.angular_velocity.setZero();
  const auto drive = [&](const Joint& hinge, const char* angle) {
    Driver& driver = scene.drivers.emplace_back();
    driver.name = fmt::format("motor{}", scene.drivers.size());
    driver.i = hinge.i, driver.j = hinge.j;
    driver.axis = hinge.axis;  // body i's frame is the global one at the start
    driver.value = Expression::parse(angle);
  };
  if (carried) {
    scene.joints[0].axis = kSkew;
    drive(scene.joints[0], kDrivenTurn);
  }
  drive(scene.joints[carried ? 1 : 0], "0.5*sin(2.5*t)");
  return scene;
}

TEST_P(Machines, KinematicsOfADrivenFourBarAreThoseWithoutRedundancy) {
  for (const Frames frames : {Frames::drawn, Frames::quarter_turns, Frames::random}) {
    for (const bool carried : {false, true}) {
      for (const char* jacobian : {"exact", "kept"}) {
        for (const double step : {1e-2, 0.1}) {
          SCOPED_TRACE(fmt::format("{} frames {} {} step {}{}", GetParam(), static_cast<int>(frames), jacobian, step,
                                   carried ? ", carried" : ""));
          Settings settings = kinematics(GetParam(), step, 3, 0.1);
          settings.jacobian = jacobian;
          const Course with = move(driven_four_bar(frames, carried, true), settings),
                       without = move(driven_four_bar(frames, carried, false), settings);
          ASSERT_TRUE(with.outcome.status.ok()) << with.outcome.status.message;
          ASSERT_TRUE(without.outcome.status.ok()) << without.outcome.status.message;
          ASSERT_EQ(with.samples.size(), 31u);
          EXPECT_LT(motions_apart(with, without), 1e-8);
          EXPECT_GT(moved(with, carried ? 1 : 0, carried ? 2 : 1), 0.02);  // crank and coupler
          EXPECT_EQ(with.exchanges > 0, carried);
        }
      }
    }
  }
}

// A tolerance leaves kept rows off, and what follows from them by as much.
TEST_P(Machines, KinematicsToALooseToleranceAreNoContradiction) {
  for (const char* jacobian : {"exact", "kept", "simplified"}) {
    for (const double step : {0.02, 0.05, 0.1}) {
      for (const Frames frames : {Frames::drawn, Frames::random}) {
        SCOPED_TRACE(fmt::format("{} {} step {}", GetParam(), jacobian, step));
        const Scene scene = driven_four_bar(frames, true, true);  // in a plane that turns: rows mix what is across it
        Settings settings = kinematics(GetParam(), step, 3, 0.1);
        settings.jacobian = jacobian, settings.tolerance = 1e-3;
        const Course course = move(scene, settings);
        ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
        settings.tolerance = 1e-12;
        EXPECT_LT(motions_apart(course, move(scene, settings)), 1e-2);
      }
    }
  }
}

// The parts of a long step turn bodies by more than serves one choice of rows, or one chart.
TEST_P(Machines, KinematicsInLongStepsChooseRowsAndChartsWithinThem) {
  for (const bool redundant : {true, false}) {
    for (const double step : {0.5, 0.55, 0.6, 0.8, 1.0}) {
      SCOPED_TRACE(fmt::format("{} step {}{}", GetParam(), step, redundant ? ", redundant" : ""));
      for (const Frames frames : {Frames::drawn, Frames::random}) {
        const Scene scene = driven_four_bar(frames, true, redundant);
        const double end = step * std::ceil(9 / step);
        const Course course = move(scene, kinematics(GetParam(), step, end, end)),
                     fine = move(scene, kinematics(GetParam(), step / 50, end, end));
        ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
        ASSERT_TRUE(fine.outcome.status.ok()) << fine.outcome.status.message;
        EXPECT_LT(motions_apart(course, fine), 1e-8);
      }
    }
  }
}

// Before kept rows come to be dependent: a simplified matrix would not serve there, nor would usual steps.
TEST_P(Machines, RowsAreExchangedBeforeTheyWearOut) {
  Settings fixed = dynamics(GetParam(), 1e-3, 0.6, 0.6);
  fixed.jacobian = "simplified";
  fixed.tolerance = 1e-6;
  const Course course = move(leg(Base::hinged, Frames::quarter_turns, false, true), fixed);
  ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
  EXPECT_EQ(course.outcome.statistics.divided_steps, 0);
  EXPECT_THAT(course.outcome.notices, ::testing::Not(::testing::Contains(::testing::HasSubstr("singular position"))));

  Settings controlled = dynamics(GetParam(), 1e-3, 2, 2);
  controlled.integrator = "dop853";
  controlled.rtol = 1e-8;
  const auto rejected = [&](bool redundant) {
    return move(faster(loop({8, Frames::random, true, redundant})), controlled).outcome.statistics.rejected_steps;
  };
  EXPECT_LE(rejected(true), rejected(false) + 2);
}

INSTANTIATE_TEST_SUITE_P(All, Machines, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace poinsot::test
