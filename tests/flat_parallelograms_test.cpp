// Parallelograms of three and more cranks that start flat: a singular position of a mechanism whose joints constrain
// too often. Off the positions where all rows hold those that keep it in its plane look independent as well.
#include <gmock/gmock.h>

#include "integrators/start/rank.h"
#include "integrators/start/violation.h"
#include "tests/support/course.h"
#include "tests/support/every_way.h"
#include "tests/support/paradoxic.h"
#include "tests/support/scene_transform.h"

namespace poinsot::test {
namespace {

constexpr double kSpin = 2, kCrank = 0.5, kUntil = 0.3;  // rad/s, m, s

struct Stack {
  int levels = 1, cranks = 3;
  Frames frames = Frames::drawn;
  double spin = kSpin;  // rad/s, of all cranks
  double angle = 0;     // rad, of all cranks at the start
};

// Couplers on cranks on couplers, all along the x axis.
Scene stacked(const Stack& of) {
  Paradoxic made("stack", {of.frames});
  Scene& scene = made.scene();
  scene.gravity.setZero();
  const Vector3 z = Vector3::UnitZ(), crank(kCrank * std::cos(of.angle), kCrank * std::sin(of.angle), 0),
                velocity = of.spin * z.cross(crank);
  int below = made.base();
  Vector3 foot = Vector3::Zero(), carried = Vector3::Zero();
  for (int level = 0; level < of.levels; ++level) {
    const auto at = [&](int k) -> Vector3 { return foot + Vector3(0.4 * k, 0, 0); };
    const int coupler = made.link("coupler", at(0) + crank, at(of.cranks - 1) + crank, 2);
    for (int k = 0; k < of.cranks; ++k) {
      const int link = made.link("crank", at(k), at(k) + crank);
      Body& body = scene.bodies[static_cast<std::size_t>(link)];
      body.velocity = carried + 0.5 * velocity;
      body.angular_velocity = body.orientation.transpose() * (of.spin * z);
      made.hinge(below, link, {at(k), z});
      made.hinge(link, coupler, {at(k) + crank, z});
    }
    foot += crank, carried += velocity;
    scene.bodies[static_cast<std::size_t>(coupler)].velocity = carried;
    below = coupler;
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) scene.bodies[b].name += fmt::format("{}", b);
  return scene;
}

double crank_angle(const Scene& scene, const Snapshot& at, std::size_t body) {
  const Matrix3 A = at.bodies[body].A * scene.bodies[body].orientation.transpose();
  return std::atan2(A(1, 0), A(0, 0));
}

// Without gravity one level turns evenly, its coupler not at all.
double off_even_turns(const Scene& scene, const Course& course) {
  double off = 0;
  for (const Snapshot& sample : course.samples)
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      off = std::max(off, std::abs(crank_angle(scene, sample, b) - (b == 0 ? 0 : kSpin * sample.t)));
  return off;
}

RankAnalysis rank_of_flat(const Scene& scene) {
  const auto model = std::make_shared<const Model>(compile(scene));
  return analyze_rank(model, given_state(*model), RankNames::all);
}

class FlatParallelograms : public ::testing::TestWithParam<Frames> {};

INSTANTIATE_TEST_SUITE_P(All, FlatParallelograms,
                         ::testing::Values(Frames::drawn, Frames::quarter_turns, Frames::random));

TEST_P(FlatParallelograms, AreLeftAlongTheVelocities) {
  for (const int cranks : {3, 4}) {
    const Scene scene = stacked({1, cranks, GetParam()});
    const int ways = in_every_way(2.5e-3, kUntil, [&](Settings settings) {
      SCOPED_TRACE(cranks);
      settings.tolerance = 1e-8;
      settings.rtol = 1e-8;
      const Course course = move(scene, settings);
      ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
      EXPECT_LT(off_even_turns(scene, course), integrators().require(settings.integrator).order == 1 ? 5e-3 : 2e-5);
    });
    EXPECT_GE(ways, 25);
  }
}

// Whichever way it lies and its bodies' frames do: rows that are clearest beside the position need not be so in it.
TEST(FlatParallelogram, IsLeftHoweverItLies) {
  const Scene scene = stacked({});
  for (int seed = 1; seed <= 40; ++seed) {
    Transform lie;
    lie.R = frame(Frames::random, 100 + seed);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      lie.F.push_back(frame(Frames::random, 10 * seed + static_cast<int>(b)));
    Settings settings = dynamics("rA", 2.5e-3, 0.1);
    settings.integrator = "dop853";
    const Course course = move(lie.apply(scene), settings);
    EXPECT_TRUE(course.outcome.status.ok()) << seed << ": " << course.outcome.status.message;
  }
}

TEST_P(FlatParallelograms, AreDrivenOn) {
  Scene scene = stacked({1, 3, GetParam()});
  Driver& motor = scene.drivers.emplace_back();
  motor.name = "motor", motor.i = scene.joints[0].i, motor.j = scene.joints[0].j;
  motor.axis = Vector3::UnitZ();
  motor.value = Expression::parse("2*t");
  Settings settings = dynamics("rA", 2.5e-3, kUntil);
  settings.integrator = "dop853";
  const Course course = move(scene, settings);
  ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
  EXPECT_LT(off_even_turns(scene, course), 1e-9);
}

TEST_P(FlatParallelograms, HaveOneDegreeOfFreedomALevel) {
  for (const int cranks : {3, 4}) {
    for (const int levels : {1, 2, 3}) {
      SCOPED_TRACE(fmt::format("{} cranks, {} levels", cranks, levels));
      const RankAnalysis rank = rank_of_flat(stacked({levels, cranks, GetParam()}));
      EXPECT_TRUE(rank.singular_position());
      EXPECT_TRUE(rank.moves_on);
      EXPECT_EQ(rank.degrees_of_freedom(), levels);
    }
    EXPECT_EQ(rank_of_flat(stacked({1, cranks, GetParam(), 0})).degrees_of_freedom(), 1) << "at rest";
  }
}

// What rests tells nothing of what follows from what, and what moves nothing of what rests.
TEST_P(FlatParallelograms, HaveItBesideOneThatRests) {
  Scene scene = stacked({1, 3, GetParam()});
  const Scene resting = stacked({1, 3, GetParam(), 0});
  const int first = static_cast<int>(scene.bodies.size());
  for (const Body& body : resting.bodies) scene.bodies.emplace_back(body).name += "resting";
  for (const Joint& joint : resting.joints) {
    Joint& other = scene.joints.emplace_back(joint);
    other.name += "resting";
    for (int* body : {&other.i, &other.j})
      if (*body != kGround) *body += first;
  }
  EXPECT_EQ(rank_of_flat(scene).degrees_of_freedom(), 2);
}

TEST_P(FlatParallelograms, KeepTheirCouplersParallelInStacks) {
  for (const char* integrator : {"dop853", "radau5"}) {
    for (const int levels : {2, 3}) {
      SCOPED_TRACE(fmt::format("{} {} levels", integrator, levels));
      const Scene scene = stacked({levels, 3, GetParam()});
      Settings settings = dynamics("rA", 2.5e-3, kUntil);
      settings.integrator = integrator;
      settings.rtol = 1e-8;
      const Course course = move(scene, settings);
      ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
      for (const Snapshot& sample : course.samples)
        for (std::size_t level = 0; level < static_cast<std::size_t>(levels); ++level) {
          EXPECT_NEAR(crank_angle(scene, sample, 4 * level), 0, 1e-9);
          for (const std::size_t k : {2u, 3u})
            EXPECT_NEAR(crank_angle(scene, sample, 4 * level + k), crank_angle(scene, sample, 4 * level + 1), 1e-9);
        }
      EXPECT_GT(crank_angle(scene, course.samples.back(), 1), 0.3 * kSpin * kUntil);
    }
  }
}

// Where an output time, or the end, is the very time at which they are flat, there is no matrix to be factored.
TEST_P(FlatParallelograms, AreGivenOutWhereTheyAreFlat) {
  constexpr double kTurns = M_PI;  // rad/s
  for (const int cranks : {2, 3}) {
    Scene scene = stacked({1, cranks, GetParam(), kTurns, M_PI / 2});
    for (const bool driven : {false, true}) {
      if (driven) {
        Driver& driver = scene.drivers.emplace_back();
        driver.name = "motor", driver.i = scene.joints[0].i, driver.j = scene.joints[0].j;
        driver.axis = Vector3::UnitZ();
        driver.value = Expression::parse("pi*t");
      }
      for (const double end : {0.5, 1.0}) {
        in_every_way(2e-3, end, [&](Settings settings) {
          if (!integrators().require(settings.integrator).controls_error) return;
          for (const double rtol : {1e-6, 1e-8, 1e-10}) {
            SCOPED_TRACE(fmt::format("{} cranks, driven {}, end {}, rtol {}", cranks, driven, end, rtol));
            settings.rtol = rtol, settings.every = 0.25;
            const Recorded r = run(scene, settings);
            ASSERT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
            ASSERT_EQ(r.samples.size(), 1 + static_cast<std::size_t>(std::lround(end / 0.25)));
            for (const Snapshot& sample : r.samples) {
              EXPECT_NEAR(std::remainder(crank_angle(scene, sample, 1) - kTurns * sample.t, 2 * M_PI), 0,
                          1e-7 + 5 * rtol);
              EXPECT_NEAR(crank_angle(scene, sample, 0), 0, 1e-7 + 5 * rtol);
              EXPECT_NEAR(sample.bodies[1].w.norm(), kTurns, 1e-5);
              EXPECT_LT(sample.bodies[1].wd.norm(), 1e-3);
            }
          }
        });
      }
    }
  }
}

}  // namespace
}  // namespace poinsot::test
