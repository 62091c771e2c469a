// Mechanisms with redundant constraints over whole motions: every formulation and integrator, however their frames lie
// and wherever the hinge axes turn to, moves them as it moves the same mechanism written without redundancy.
#include <gmock/gmock.h>

#include <map>
#include <numbers>

#include "integrators/start/rank.h"
#include "integrators/start/reactions.h"
#include "tests/support/course.h"
#include "tests/support/every_way.h"
#include "tests/support/loops.h"
#include "tests/support/simulation.h"
#include "tests/support/twice_driven.h"

namespace poinsot::test {
namespace {

double apart(const Course& a, const Course& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.end().size(); ++k) {
    largest = std::max(largest, (a.end()[k].r - b.end()[k].r).norm());
    largest = std::max(largest, (a.end()[k].rd - b.end()[k].rd).norm());
  }
  return largest;
}

class Loops : public ::testing::TestWithParam<std::string> {};

TEST_P(Loops, MoveAsWithoutRedundancy) {
  int compared = 0;
  for (const IntegratorEntry& integrator : integrators()) {
    Settings settings = dynamics(GetParam(), 2e-3, 1, 1);
    settings.integrator = integrator.name;
    settings.tolerance = 1e-8;
    settings.rtol = 1e-8;
    if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
    for (const Frames frames : {Frames::drawn, Frames::quarter_turns, Frames::random}) {
      for (const bool carried : {false, true}) {
        SCOPED_TRACE(fmt::format("{} {}, frames {}{}", integrator.name, GetParam(), static_cast<int>(frames),
                                 carried ? ", carried" : ""));
        const Course with = move(loop({4, frames, carried, true}), settings);
        const Course without = move(loop({4, frames, carried, false}), settings);
        ASSERT_TRUE(with.outcome.status.ok()) << with.outcome.status.message;
        ASSERT_TRUE(without.outcome.status.ok()) << without.outcome.status.message;
        // Fixed steps: the same solution of the same equations, but for generalized-alpha's restarts. Error control:
        // the tolerance, grown over the motion.
        const bool same = !integrator.controls_error && integrator.order < 2;
        EXPECT_LT(apart(with, without), same ? 1e-7 : integrator.controls_error ? 2e-6 : 5e-3);
        EXPECT_EQ(with.exchanges > 0, carried);  // a plane that does not turn keeps the choice it began with
        EXPECT_LT(with.outcome.statistics.violation.position, 1e-8);
        std::int64_t told = 0;  // by whom, exchanges or not; auto tries solvers besides
        for (const LinearWork& work : with.outcome.statistics.linear)
          told += work.factorizations + work.refactorizations;
        EXPECT_GE(told, with.outcome.statistics.factorizations);
        ++compared;
      }
    }
  }
  EXPECT_GE(compared, 42);
}

TEST_P(Loops, OfManyLinks) {
  for (const int links : {5, 6, 8}) {
    for (const bool carried : {false, true}) {
      Settings settings = dynamics(GetParam(), 1e-3, 1, 1);
      settings.integrator = "dop853";
      settings.rtol = 1e-9;
      const Course with = move(loop({links, Frames::quarter_turns, carried, true}), settings);
      const Course without = move(loop({links, Frames::quarter_turns, carried, false}), settings);
      ASSERT_TRUE(with.outcome.status.ok()) << links << ' ' << with.outcome.status.message;
      EXPECT_LT(apart(with, without), 2e-5) << links << carried;
      EXPECT_LE(with.outcome.statistics.rejected_steps, without.outcome.statistics.rejected_steps + 1) << links;
    }
  }
}

// A loop of revolutes in space, the last link the ground, by lengths, twists and angles (Denavit and Hartenberg): each
// body's frame is that at its far end, z the next hinge and x along the link.
Scene linkage(const std::vector<double>& length, const std::vector<double>& twist, const std::vector<double>& angle) {
  Scene scene;
  scene.name = "linkage";
  scene.gravity = {1, -9.81, -2};
  Matrix3 A = Matrix3::Identity();
  Vector3 at = Vector3::Zero();
  const int links = static_cast<int>(length.size());
  for (int k = 0; k < links; ++k) {
    const auto n = static_cast<std::size_t>(k);
    const bool ground = k + 1 == links;
    Joint& hinge = scene.joints.emplace_back();
    hinge.name = fmt::format("hinge{}", k + 1);
    hinge.i = k - 1, hinge.j = ground ? kGround : k;
    hinge.point = at;
    hinge.axis = A.col(2);
    A = A * Eigen::AngleAxisd(angle[n], Vector3::UnitZ()) * Eigen::AngleAxisd(twist[n], Vector3::UnitX());
    at += length[n] * A.col(0);
    if (ground) break;
    Body& body = scene.bodies.emplace_back();
    body.name = fmt::format("link{}", k + 1);
    body.mass = 1 + 0.1 * k;
    body.inertia = Vector3(0.02, 0.1, 0.11).asDiagonal();
    body.position = at - 0.5 * length[n] * A.col(0);
    body.orientation = A;
  }
  check(at.norm() < 1e-12 && (A - Matrix3::Identity()).norm() < 1e-12, "the linkage closes");
  return scene;
}

// The angle of joint 1 and of joint 2.
std::pair<double, double> first_angles(const std::vector<BodyState>& bodies) {
  const Matrix3 &A = bodies[0].A, &B = bodies[1].A;
  return {std::atan2(A(1, 0), A(0, 0)), std::atan2(A.col(2).dot(A.col(0).cross(B.col(0))), A.col(0).dot(B.col(0)))};
}

struct Bennett {
  double alpha = 0.7, beta = 1.2, product = std::sin((beta + alpha) / 2) / std::sin((beta - alpha) / 2);
  double length = std::sin(beta) / std::sin(alpha), t1 = 1, t2 = 2 * std::atan(product / std::tan(t1 / 2));

  Scene scene() const { return linkage({1, length, 1, length}, {alpha, beta, alpha, beta}, {t1, t2, -t1, -t2}); }
};

struct Bricard {
  double q = std::numbers::pi / 2, u1 = 1.2, u2 = std::acos(-std::cos(u1) / (1 + std::cos(u1)));

  Scene scene() const { return linkage(std::vector<double>(6, 1), {q, -q, q, -q, q, -q}, {u1, u2, u1, u2, u1, u2}); }
};

// Bennett's linkage, four hinges, and Bricard's orthogonal one, six: no count of rows lets them move. In closed form
// tan(θ₁/2) tan(θ₂/2) and cosθ₁ + cosθ₂ + cosθ₁ cosθ₂ stay what they are.
TEST_P(Loops, ThatMoveByTheirDimensionsAlone) {
  const Bennett bennett;
  const Bricard bricard;
  for (const bool four : {true, false}) {
    const Scene scene = four ? bennett.scene() : bricard.scene();
    static std::map<bool, std::vector<BodyState>> exact;
    if (!exact.contains(four)) exact[four] = move(scene, controlled("dop853", "rA", 1e-11, 1)).end();
    for (const char* integrator : {"dop853", "radau5", "rattle", "generalized_alpha", "implicit_euler"}) {
      SCOPED_TRACE(fmt::format("{} {}", four ? "Bennett" : "Bricard", integrator));
      Settings settings = dynamics(GetParam(), 1e-3, 1, 0.25);
      settings.integrator = integrator;
      settings.rtol = 1e-8;
      const Recorded r = run(scene, settings);
      ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
      ASSERT_EQ(r.samples.size(), 5u);
      double turned = 0;
      for (const Snapshot& sample : r.samples) {
        const auto [one, two] = first_angles(sample.bodies);
        const double c = std::cos(one), d = std::cos(two);
        EXPECT_NEAR(four ? std::tan(one / 2) * std::tan(two / 2) - bennett.product : c + d + c * d, 0, 1e-6);
        turned = std::max(turned, std::abs(one - (four ? bennett.t1 : bricard.u1)));
      }
      EXPECT_GT(turned, 0.3);
      double apart = 0;
      for (std::size_t k = 0; k < exact[four].size(); ++k)
        apart = std::max(apart, (r.samples.back().bodies[k].r - exact[four][k].r).norm());
      const int order = integrators().require(integrator).order;
      EXPECT_LT(apart, order == 1 ? 3e-2 : order == 2 ? 1e-4 : 1e-6);
    }
  }
}

// The linkage, its last link of 1 m, with so many rows in the place of its last hinge, to the ground: of the point's
// coordinates, in the order of the axes, and of the hinge's direction against one across it. They let it move along the
// same curve, up to 0.9 s where two of the rows that are left of Bennett's come to depend on one another.
Scene without_redundancy(Scene scene, const std::vector<int>& coordinates, bool direction) {
  const Joint last = scene.joints.back();
  scene.joints.pop_back();
  const auto row = [&](ConstraintType type) -> Constraint& {
    Constraint& one = scene.constraints.emplace_back();
    one.type = type, one.i = last.i, one.j = kGround;
    return one;
  };
  for (const int k : coordinates) {
    Constraint& point = row(ConstraintType::CD);
    point.c = Vector3::Unit(k), point.s_i = {0.5, 0, 0}, point.s_j = last.point;
  }
  if (direction) {
    Constraint& across = row(ConstraintType::DP1);
    across.a_i = Vector3::UnitZ(), across.a_j = scene.bodies.back().orientation.col(0);
  }
  return scene;
}

TEST_P(Loops, ThatMoveByTheirDimensionsAloneMoveAsWithoutRedundancy) {
  for (const bool four : {true, false}) {
    const Scene redundant = four ? Bennett().scene() : Bricard().scene();
    const Scene plain =
        four ? without_redundancy(redundant, {1, 2}, false) : without_redundancy(redundant, {0, 1, 2}, true);
    for (const IntegratorEntry& integrator : integrators()) {
      Settings settings = dynamics(GetParam(), 1e-3, 0.8, 0.8);
      settings.integrator = integrator.name;
      settings.tolerance = 1e-8;
      settings.rtol = 1e-9;
      if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
      SCOPED_TRACE(fmt::format("{} {}", four ? "Bennett" : "Bricard", integrator.name));
      const Course with = move(redundant, settings), without = move(plain, settings);
      ASSERT_TRUE(with.outcome.status.ok()) << with.outcome.status.message;
      ASSERT_TRUE(without.outcome.status.ok()) << without.outcome.status.message;
      const bool restarts = !integrator.controls_error && integrator.order == 2;  // where rows are exchanged
      EXPECT_LT(apart(with, without), restarts ? 1e-4 : 1e-7);
    }
  }
}

// A hinge that the scene has twice is that hinge.
TEST(OverConstrained, OfAHingeGivenTwice) {
  const Scene once = scene_of("double_pendulum_joints");
  Scene twice = once;
  for (const Joint& joint : once.joints) {
    twice.joints.push_back(joint);
    twice.joints.back().name = fmt::format("again{}", twice.joints.size());
  }
  const int ways = in_every_way(1e-3, 1, [&](Settings settings) {
    settings.every = 1;
    settings.rtol = 1e-8;
    const Course with = move(twice, settings), without = move(once, settings);
    ASSERT_TRUE(with.outcome.status.ok()) << with.outcome.status.message;
    EXPECT_LT(apart(with, without), settings.integrator == "ida" ? 1e-6 : 1e-9);  // IDA's own tolerance
  });
  EXPECT_GE(ways, 25);
}

INSTANTIATE_TEST_SUITE_P(All, Loops, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// Other rows, other multipliers; the reactions given out are the least and know nothing of it.
TEST(OverConstrained, ReactionsAreContinuousWhereRowsAreExchanged) {
  const int ways = in_every_way(1e-3, 1, [](Settings settings) {
    settings.every = 0;
    settings.tolerance = settings.rtol = 1e-8;
    std::optional<Reactions> reactions;
    Vector3 force, moment, before = Vector3::Zero();
    int revision = 0, exchanges = 0;
    double at = 0, usual = 0, across = 0;  // N/s
    const Outcome outcome = simulate(loop({4, Frames::random, true, true}), settings, [&](const Sample& sample) {
      if (!reactions) reactions.emplace(sample.problem);
      reactions->update(sample);
      reactions->of_group(3, force, moment);
      if (sample.t > 0.01) {
        const double jump = (force - before).norm() / (sample.t - at);
        if (sample.problem.revision() == revision) {
          usual = std::max(usual, jump);
        } else {
          across = std::max(across, jump);
          ++exchanges;
        }
      }
      revision = sample.problem.revision();
      before = force, at = sample.t;
    });
    ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
    EXPECT_GT(exchanges, 0);
    EXPECT_LT(across, 2 * usual);
  });
  EXPECT_GE(ways, 25);
}

// Multistep methods keep what they know of the motion where rows are exchanged, and rows that are set aside are watched
// without a system solved at every step.
TEST(OverConstrained, IdaGoesOnOverAnExchange) {
  Settings settings = dynamics("rp", 2e-3, 1, 1);
  settings.integrator = "ida";
  settings.rtol = 1e-8;
  const Course with = move(loop({4, Frames::quarter_turns, true, true}), settings);
  const Course without = move(loop({4, Frames::quarter_turns, true, false}), settings);
  ASSERT_TRUE(with.outcome.status.ok()) << with.outcome.status.message;
  ASSERT_TRUE(without.outcome.status.ok()) << without.outcome.status.message;
  EXPECT_GT(with.exchanges, 0);
  const Statistics &a = with.outcome.statistics, &b = without.outcome.statistics;
  EXPECT_LT(a.steps, 1.2 * static_cast<double>(b.steps));
  EXPECT_LT(a.factorizations, a.steps / 4);
  EXPECT_LT(apart(with, without), 2e-6);
}

TEST(OverConstrained, SaysWhichReactionsAreDetermined) {
  Scene scene = loop({4, Frames::drawn, false, true});
  Body& pendulum = scene.bodies.emplace_back(scene.bodies[0]);
  pendulum.name = "pendulum";
  pendulum.position = {5, 0, 0};
  Joint& hinge = scene.joints.emplace_back(scene.joints[0]);
  hinge.name = "hinge";
  hinge.i = kGround, hinge.j = 3;
  hinge.point = {5, 1, 0};
  const Outcome outcome = simulate(scene, dynamics("rA", 1e-3, 1e-3), {});
  EXPECT_THAT(outcome.undetermined_reactions, ::testing::ElementsAre("joint1", "joint2", "joint3", "joint4"));
  EXPECT_THAT(outcome.undetermined_components, ::testing::Each(::testing::ElementsAre("fz", "nx", "ny")));
}

// A driver set aside because it agrees with another one at the start, and later does not.
TEST(OverConstrained, ARowThatDoesNotFollowAnyMoreStopsTheRun) {
  const Scene scene = twice_driven("t", "t + t^5");
  const int compared = in_every_way(1e-3, 1, [&](const Settings& settings) {
    const Course m = move(scene, settings);
    EXPECT_EQ(m.outcome.status.failure, Failure::constraint_lost) << m.outcome.status.message;
    EXPECT_THAT(m.outcome.status.message, ::testing::HasSubstr("driver 't"));
    EXPECT_GT(m.outcome.status.time, 0.01);
    EXPECT_LT(m.outcome.status.time, 0.2);
  });
  EXPECT_GE(compared, 25);
}

// What Newton's tolerance leaves rows that are kept off by adds up in those that follow from them. That is no
// contradiction, and the smaller tolerance that is offered serves.
TEST(OverConstrained, RowsThatAToleranceLeavesOffDoNotContradict) {
  int stopped = 0;
  in_every_way(0.1, 1, [&](Settings settings) {
    settings.stopping = "relative";
    settings.tolerance = 1e-3;
    for (const Frames frames : {Frames::quarter_turns, Frames::random}) {
      const Scene scene = loop({4, frames, true, true});
      const Course coarse = move(scene, settings);
      EXPECT_THAT(coarse.outcome.status.message, ::testing::Not(::testing::HasSubstr("contradict")));
      if (coarse.outcome.status.failure != Failure::constraint_lost) continue;
      ++stopped;
      EXPECT_THAT(coarse.outcome.status.message, ::testing::HasSubstr("the tolerance of Newton's method"));
      Settings finer = settings;
      finer.tolerance = 1e-6;
      EXPECT_NE(move(scene, finer).outcome.status.failure, Failure::constraint_lost);
    }
  });
  EXPECT_GT(stopped, 0);
}

// Off by less than what stops a run, and in the record all the same.
TEST(OverConstrained, RowsSetAsideCountAsViolated) {
  const Scene scene = twice_driven("t", "t + 0.001*t^5");
  const int ways = in_every_way(1e-3, 0.2, [&](const Settings& settings) {
    const Course m = move(scene, settings);
    EXPECT_TRUE(m.outcome.status.ok()) << m.outcome.status.message;
    EXPECT_NEAR(m.outcome.statistics.violation.position, 0.001 * std::pow(0.2, 5), 1e-8);
    EXPECT_GT(m.outcome.statistics.violation.velocity, 0.0049 * std::pow(0.2, 4));  // or as the method leaves it
  });
  EXPECT_GE(ways, 25);
}

TEST(OverConstrained, StartsThatLeadNowhereAreRefusedByName) {
  for (const bool redundant : {true, false}) {
    in_every_way(1e-3, 1, [&](const Settings& settings) {
      const Course m = move(posts(1, 0, 0, redundant), settings);
      EXPECT_EQ(m.outcome.status.failure, Failure::singular_position) << redundant;
      EXPECT_THAT(m.outcome.status.message, ::testing::HasSubstr("singular here: joint 'joint4'")) << redundant;
      EXPECT_THAT(m.outcome.status.message, ::testing::HasSubstr("start beside it")) << redundant;
      EXPECT_TRUE(m.end().empty());
    });
  }
  // So near to it that rank does not tell it apart that is said, not that it is one.
  for (const double angle : {1e-7, 1e-5}) {
    in_every_way(1e-3, 0.1, [&](const Settings& settings) {
      const Course near = move(posts(2, angle, 0, false), settings), beside = move(posts(2, 1e-3, 0, false), settings);
      EXPECT_THAT(near.outcome.status.message, ::testing::HasSubstr("or within 1e-04 rad"));
      EXPECT_THAT(near.outcome.status.message, ::testing::HasSubstr("start beside it, by 1e-03 or more"));
      EXPECT_TRUE(beside.outcome.status.ok()) << beside.outcome.status.message;
    });
  }
  // The remedies that are named.
  in_every_way(1e-3, 0.1, [&](const Settings& settings) {
    const Course beside = move(posts(1, 0.05, 0, true), settings), moving = move(posts(1, 0, -3, true), settings);
    EXPECT_TRUE(beside.outcome.status.ok()) << beside.outcome.status.message;
    EXPECT_TRUE(moving.outcome.status.ok()) << moving.outcome.status.message;
  });
}

// Flat, and within rounding of flat, with a velocity: accelerations are those beside, not of order 1e16. A run that
// ends is right; radau5 beside the position, where the constraints hold by rounding only, may stop.
TEST_P(Loops, StartInASingularPositionFollowsTheVelocities) {
  const double phi = swung(1, 0, -3, 0.2);
  const Vector3 at(0.5 * std::cos(phi), 0.5 * std::sin(phi), 0);
  int ended = 0;
  for (const double angle : {0.0, 1e-13, 1e-7}) {
    for (const bool redundant : {true, false}) {
      for (const char* integrator : {"implicit_euler", "dop853", "radau5"}) {
        SCOPED_TRACE(fmt::format("{} {} {} {}", GetParam(), integrator, angle, redundant));
        Settings settings = dynamics(GetParam(), 1e-4, 0.2, 0.1);
        settings.integrator = integrator;
        settings.stopping = Settings{}.stopping;
        settings.tolerance = 1e-6;
        settings.rtol = 1e-9;
        const Course flat = move(posts(1, angle, -3, redundant), settings);
        EXPECT_THAT(flat.outcome.notices, ::testing::Contains(::testing::HasSubstr("singular position")));
        EXPECT_TRUE(flat.outcome.status.ok() || settings.integrator == "radau5") << flat.outcome.status.message;
        if (!flat.outcome.status.ok()) continue;
        ++ended;
        EXPECT_LT((flat.end()[0].r - at).norm(), settings.integrator == "implicit_euler" ? 1e-4 : 1e-6);
      }
    }
  }
  EXPECT_GE(ended, 13);
}

}  // namespace
}  // namespace poinsot::test
