// Where two branches of a mechanism come close to one another without meeting, methods with error control stay on
// theirs: a step that would go straight over the gap between them is done in shorter ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "core/scene_reader.h"
#include "tests/support/controlled_ways.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using std::numbers::pi;

// The last state of body 0.
struct Ended {
  Status status;
  BodyState body;
};
Ended ended(const Scene& scene, const Settings& settings) {
  Ended end;
  std::vector<BodyState> states(scene.bodies.size());
  end.status = simulate(scene, settings, [&](const Sample& x) {
                 x.problem.to_bodies(x.a, states);
                 end.body = states.back();
               }).status;
  return end;
}

// A slider whose distance from a point beside its line is driven: it comes to the foot of that point but for `gap` and
// goes back; it comes there after `in` seconds.
Scene driven_slider(double gap, double in = 1) {
  const double x = std::hypot(in, gap);
  return parse_scene(fmt::format(R"j({{"scene": 1, "bodies": [{{"name": "b", "mass": 1, "inertia": [1, 1, 1],
      "position": [{0:.17g}, 0.5, 0], "velocity": [{1:.17g}, 0, 0]}}],
      "joints": [{{"type": "translational", "bodies": ["ground", "b"], "point": [{0:.17g}, 0.5, 0], "axis": [1, 0, 0]}}],
      "drivers": [{{"type": "distance", "bodies": ["ground", "b"], "s_i": [0, 0, 0], "s_j": [0, 0, 0],
      "length": "sqrt((t-{3:.17g})^2+{2:.17g})"}}]}})j",
                                 x, -in / x, 0.25 + gap * gap, in),
                     "slider");
}

// A crank of length 1 at 2πt + 0.5 and a rod of length 1 + longer to a slider on the crank's axis x.
Scene slider_crank(double longer) {
  const double angle = 0.5, rod = 1 + longer, sine = std::sin(angle) / rod, cosine = std::sqrt(1 - sine * sine);
  const double x = std::cos(angle) + rod * cosine;
  return parse_scene(fmt::format(R"j({{"scene": 1, "bodies": [
      {{"name": "crank", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [{0:.17g}, {1:.17g}, 0]}},
      {{"name": "rod", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [{2:.17g}, {1:.17g}, 0]}},
      {{"name": "slider", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [{3:.17g}, 0, 0]}}],
      "joints": [
      {{"type": "revolute", "bodies": ["ground", "crank"], "point": [0, 0, 0], "axis": [0, 0, 1]}},
      {{"type": "cylindrical", "bodies": ["crank", "rod"], "point": [{4:.17g}, {5:.17g}, 0], "axis": [0, 0, 1]}},
      {{"type": "spherical", "bodies": ["rod", "slider"], "point": [{3:.17g}, 0, 0]}},
      {{"type": "translational", "bodies": ["ground", "slider"], "point": [{3:.17g}, 0, 0], "axis": [1, 0, 0]}}],
      "drivers": [{{"type": "angle", "bodies": ["ground", "crank"], "axis": [0, 0, 1], "angle": "2*pi*t"}}]}})j",
                                 0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.5 * (std::cos(angle) + x), x,
                                 std::cos(angle), std::sin(angle)),
                     "slider_crank");
}
double slider_at(double longer, double t) {
  const double angle = 2 * pi * t + 0.5, rod = 1 + longer;
  return std::cos(angle) + std::sqrt(rod * rod - std::sin(angle) * std::sin(angle));
}

class NarrowGaps : public ControlledWays {
 protected:
  Ended ended(const Scene& scene, double rtol, double end) const {
    return test::ended(scene, settings(rtol, end, end));
  }
};
INSTANTIATE_TEST_SUITE_P(All, NarrowGaps, ::testing::ValuesIn(controlled_ways()), name_of_way);

TEST_P(NarrowGaps, ASliderTurnsRoundBeforeItsFoot) {
  for (const double gap : {1e-3, 3e-4, 1e-4, 1e-5})
    for (const double rtol : {1e-6, 1e-8, 1e-10}) {
      SCOPED_TRACE(fmt::format("{} {}", gap, rtol));
      const Ended end = ended(driven_slider(gap), rtol, 1.7301);
      ASSERT_TRUE(end.status.ok()) << end.status.message;
      EXPECT_NEAR(end.body.r.x(), std::hypot(0.7301, gap), 1e-4);
      EXPECT_NEAR(end.body.rd.x(), 1, 1e-3);
    }
}

// Steps that end right before the foot have accelerations there that lead afar in a step of the usual length.
TEST_P(NarrowGaps, ASliderThatComesThereFromNearby) {
  for (const double gap : {1e-5, 1e-6})
    for (const double in : {0.4, 0.34, 0.28, 0.22, 0.12}) {
      SCOPED_TRACE(fmt::format("{} {}", gap, in));
      const Ended end = ended(driven_slider(gap, in), 1e-7, in + 0.3);
      ASSERT_TRUE(end.status.ok()) << end.status.message;
      EXPECT_NEAR(end.body.r.x(), std::hypot(0.3, gap), 1e-4);
    }
}

TEST_P(NarrowGaps, ASliderCrankOfAllButEqualLengths) {
  for (const double longer : {1e-6, 1e-8, 1e-9})
    for (const double rtol : {1e-6, 1e-10}) {
      SCOPED_TRACE(fmt::format("{} {}", longer, rtol));
      const Ended end = ended(slider_crank(longer), rtol, 0.5);
      if (longer < 1e-8 && !end.status.ok()) continue;  // stops beside the position
      ASSERT_TRUE(end.status.ok()) << end.status.message;
      EXPECT_NEAR(end.body.r.x(), slider_at(longer, 0.5), 1e-4);
    }
}

// The rod is too short for the crank to pass.
TEST_P(NarrowGaps, NoMethodPassesWhatCannotBeReached) {
  for (const auto& [longer, rtol] : {std::pair(-1e-6, 1e-10), {-1e-8, 1e-6}, {-1e-9, 1e-10}}) {
    SCOPED_TRACE(fmt::format("{} {}", longer, rtol));
    EXPECT_FALSE(ended(slider_crank(longer), rtol, 0.5).status.ok());
  }
}

// With a degree of freedom det G does not tell: the crank turns by itself, and the slider belongs to its angle.
TEST_P(NarrowGaps, ACrankThatIsFree) {
  for (const double longer : {1e-4, 1e-6, 1e-8})
    for (const double rtol : {1e-6, 1e-8}) {
      SCOPED_TRACE(fmt::format("{} {}", longer, rtol));
      Scene scene = slider_crank(longer);
      scene.drivers.clear();
      const double rate = 6, sine = std::sin(0.5), cosine = std::cos(0.5),
                   along = std::sqrt(std::pow(1 + longer, 2) - sine * sine);
      const double speed = -sine * rate * (1 + cosine / along);  // of the slider
      scene.bodies[0].angular_velocity = {0, 0, rate};
      scene.bodies[0].velocity = 0.5 * rate * Vector3(-sine, cosine, 0);
      scene.bodies[1].angular_velocity = {0, 0, -cosine * rate / along};
      scene.bodies[1].velocity = 0.5 * Vector3(speed - sine * rate, cosine * rate, 0);
      scene.bodies[2].velocity = {speed, 0, 0};
      double apart = 0;
      std::vector<BodyState> states(scene.bodies.size());
      const Outcome run = simulate(scene, settings(rtol, 0.6, 0), [&](const Sample& x) {
        x.problem.to_bodies(x.a, states);
        const Vector3 end = 2 * states[0].r;
        apart = std::max(apart,
                         std::abs(states[2].r.x() - end.x() - std::sqrt(std::pow(1 + longer, 2) - end.y() * end.y())));
      });
      EXPECT_TRUE(run.status.ok()) << run.status.message;
      EXPECT_LT(apart, 1e-6);
    }
}

// Where branches cross the motion goes straight on.
TEST_P(NarrowGaps, ACrossingIsNone) {
  for (const double rtol : {1e-6, 1e-8}) {
    const Ended end = ended(slider_crank(0), rtol, 0.5);
    ASSERT_TRUE(end.status.ok()) << end.status.message;
    EXPECT_NEAR(end.body.r.x(), 2 * std::cos(pi + 0.5), 1e-4);
  }
}

// Neither is a link of a milligram that whips round within a microsecond, between a ball joint and a universal joint
// that is nearly locked: its part in the way out of the constraints is reversed while nothing of size is. Energy is
// kept.
TEST_P(NarrowGaps, ALightLinkThatWhipsRoundIsNone) {
  const Scene scene = parse_scene(R"j({"scene": 1, "gravity": [0, 0, -9.81], "bodies": [
      {"name": "link", "mass": 1e-06, "inertia": [1.634e-08, 1.634e-08, 1.634e-08], "position": [0.003419, 0.136, -0.07753],
       "velocity": [0.4988, -0.06576, -0.09334], "angular_velocity": [-0.6888, -0.09384, -3.615]},
      {"name": "body", "mass": 1, "inertia": [0.05417, 0.09667, 0.1242], "position": [-0.5035, -0.02602, -0.6824],
       "velocity": [1.926, 0.8053, -1.614], "angular_velocity": [3.156, -0.9542, 1.426]}], "joints": [
      {"type": "spherical", "bodies": ["ground", "link"], "point": [0, 0, 0]},
      {"type": "universal", "bodies": ["link", "body"], "point": [0.006839, 0.2719, -0.1551],
       "axis_i": [0.6054, -0.05958, 0.7937], "axis_j": [0.03613, 0.9982, 0.04737]}]})j",
                                  "whip");
  double first = 0, last = 0, fastest = 0;
  std::vector<BodyState> states(scene.bodies.size());
  const Outcome run = simulate(scene, settings(1e-8, 1.3, 0), [&](const Sample& x) {
    x.problem.to_bodies(x.a, states);
    last = x.problem.energy();
    if (x.t == 0) first = last;
    fastest = std::max(fastest, states[0].w.norm());
  });
  EXPECT_TRUE(run.status.ok()) << run.status.message;
  EXPECT_NEAR(last, first, 1e-4 * std::abs(first));
  EXPECT_GT(fastest, 1e3);
}

// Steps of fixed length go over gaps, and are found out; no run ends on the other branch.
class GapsInSteps : public ::testing::TestWithParam<std::string> {
 protected:
  struct Count {
    int right = 0, over = 0;
  };
  // Of body 0 at `end`, which is to be at x on its branch.
  void run(const Scene& scene, double end, double x, double order_of_magnitude, Count& count) const {
    for (const IntegratorEntry& integrator : integrators()) {
      if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
      for (const int steps : {40, 200, 2000}) {
        SCOPED_TRACE(fmt::format("{} {}", integrator.name, steps));
        Settings settings = dynamics(GetParam(), end / steps, end);
        settings.integrator = integrator.name;
        const Ended found = ended(scene, settings);
        count.over += found.status.message.find("gone over to another branch") != std::string::npos;
        if (!found.status.ok()) continue;
        ++count.right;
        EXPECT_NEAR(found.body.r.x(), x, order_of_magnitude);
      }
    }
  }
};
INSTANTIATE_TEST_SUITE_P(All, GapsInSteps, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

TEST_P(GapsInSteps, AreFoundOut) {
  Count slider, crank;
  for (const double gap : {1e-2, 1e-3, 1e-4, 1e-5}) {
    SCOPED_TRACE(gap);
    run(driven_slider(gap), 1.7301, std::hypot(0.7301, gap), 0.1, slider);
  }
  for (const double longer : {1e-4, 1e-6, 1e-8}) {
    SCOPED_TRACE(longer);
    run(slider_crank(longer), 0.5, slider_at(longer, 0.5), 0.1, crank);
  }
  for (const Count& count : {slider, crank}) {
    EXPECT_GT(count.right, 3);
    EXPECT_GT(count.over, 5);
  }
}

}  // namespace
}  // namespace poinsot::test
