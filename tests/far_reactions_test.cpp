// Reactions and accelerations of a mechanism far away from the origin: those of the same one at the origin, up to what
// rounding of positions allows, whatever the method; and the record's estimate of their error covers what is seen.
//
// Positions are rounded to δ = ε|r|. Steps of length h make velocities of them that are off by δ/h, and accelerations
// at index 1, which hold ω × v, by ω δ/h; what forces and directions add is ω² δ. Nowhere δ/h², which index 3 makes.
#include <gtest/gtest.h>

#include <limits>
#include <optional>

#include "integrators/start/reactions.h"
#include "tests/support/every_way.h"
#include "tests/support/loops.h"
#include "tests/support/scene_transform.h"

namespace poinsot::test {
namespace {

// What is given out at an output time: of bodies the accelerations of centres and of turning, of joints the reactions.
struct Given {
  std::vector<Vector3> accelerations, reactions;
  std::vector<double> lambda;
};

struct FarRun {
  Outcome outcome;
  std::vector<Given> given;
};

FarRun reactions_of(const Scene& scene, Settings settings) {
  FarRun r;
  std::optional<Reactions> reactions;
  settings.reactions = true;
  r.outcome = simulate(scene, settings, [&](const Sample& sample) {
    if (!reactions) reactions.emplace(sample.problem);
    reactions->update(sample);
    Given& given = r.given.emplace_back();
    for (const BodyState& body : snapshot(sample).bodies) {
      given.accelerations.push_back(body.rdd);
      given.accelerations.push_back(body.A * body.wd);
    }
    for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) {
      Vector3 force, moment;
      reactions->of_group(static_cast<int>(joint), force, moment);
      given.reactions.push_back(force);
      given.reactions.push_back(moment);
    }
    given.lambda.assign(sample.lambda.begin(),
                        sample.lambda.begin() + static_cast<std::ptrdiff_t>(sample.problem.model_rows().size()));
  });
  return r;
}

double most_apart(const std::vector<Vector3>& x, const std::vector<Vector3>& y, const Matrix3& R) {
  double most = x.size() == y.size() && !x.empty() ? 0 : INFINITY;
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k) {
    const double d = (R.transpose() * x[k] - y[k]).norm();
    most = d <= most ? most : std::isnan(d) ? INFINITY : d;
  }
  return most;
}

struct Off {
  double acceleration = 0, reaction = 0;
};
Off off(const FarRun& run, const FarRun& from, const Matrix3& R) {
  if (run.given.size() != from.given.size() || run.given.empty()) return {INFINITY, INFINITY};
  Off most;
  for (std::size_t n = 0; n < run.given.size(); ++n) {
    most.acceleration =
        std::max(most.acceleration, most_apart(run.given[n].accelerations, from.given[n].accelerations, R));
    most.reaction = std::max(most.reaction, most_apart(run.given[n].reactions, from.given[n].reactions, R));
  }
  return most;
}

constexpr double kFars[] = {1e3, 1e6, 1e8};

// A four-bar in a plane that lies askew, so that no coordinate of its place is small; a metre in size, some 3 kg, and
// from rest up to 3 rad/s within the fifth of a second.
Scene four_bar() {
  return loop({4, Frames::random, false, false});
}
constexpr double kFarEnd = 0.2, kRate = 3, kFarMass = 3.3;

Transform moved_by(double far) {
  Transform moved;
  moved.R = frame(Frames::random, 7);
  moved.t = far * Vector3(1, -2, 1.5).normalized();
  return moved;
}

double rounding(double far) {
  return std::numeric_limits<double>::epsilon() * far;
}

TEST(FarReactions, AreThoseAtTheOriginUpToTheRoundingOfPositions) {
  const FarRun exact = reactions_of(four_bar(), controlled("dop853", "rp", 1e-12, kFarEnd, kFarEnd / 4));
  ASSERT_TRUE(exact.outcome.status.ok()) << exact.outcome.status.message;
  for (const double step : {1e-2, 1e-3, 2.5e-4}) {
    const int ways = in_every_way(step, kFarEnd, [&](Settings settings) {
      const bool controls_error = integrators().require(settings.integrator).controls_error;
      if (controls_error && step < 1e-2) return;
      settings.every = kFarEnd / 4;
      settings.stopping = Settings{}.stopping;
      settings.tolerance = 1e-8;
      settings.rtol = 1e-6, settings.atol = 1e-6;
      const FarRun near = reactions_of(four_bar(), settings);
      ASSERT_TRUE(near.outcome.status.ok()) << near.outcome.status.message;
      const Off of_method = off(near, exact, Matrix3::Identity());
      for (const double far : kFars) {
        SCOPED_TRACE(fmt::format("{} m away, step {}", far, step));
        const Transform moved = moved_by(far);
        const FarRun run = reactions_of(moved.apply(four_bar()), settings);
        ASSERT_TRUE(run.outcome.status.ok()) << run.outcome.status.message;
        const double allowed =
            50 * (rounding(far) * (kRate / step + kRate * kRate) + (controls_error ? settings.rtol : 0));
        const Off seen = off(run, exact, moved.R);
        // Where index 1 takes the place of index 3 the method's own error is another one, and not larger.
        EXPECT_LT(seen.acceleration, 1.5 * of_method.acceleration + allowed);
        EXPECT_LT(seen.reaction, 1.5 * of_method.reaction + kFarMass * allowed);
      }
    });
    EXPECT_GE(ways, 25);
  }
}

// What a run far away and one at the origin differ by at the end is what one of their records says.
TEST(FarReactions, DifferByNoMoreThanTheRecordsEstimate) {
  int estimated = 0;
  for (const double step : {1e-2, 1e-3, 2.5e-4}) {
    in_every_way(step, kFarEnd, [&](Settings settings) {
      settings.every = kFarEnd;
      settings.stopping = Settings{}.stopping;
      settings.tolerance = 1e-8;
      const FarRun near = reactions_of(four_bar(), settings);
      const auto& of_near = near.outcome.statistics.acceleration_error;
      if (!of_near) return;
      for (const double far : kFars) {
        SCOPED_TRACE(fmt::format("{} m away, step {}", far, step));
        Transform moved;  // not turned: multipliers of rows are the same
        moved.t = moved_by(far).t;
        const FarRun run = reactions_of(moved.apply(four_bar()), settings);
        const auto& of_far = run.outcome.statistics.acceleration_error;
        ASSERT_TRUE(of_far);
        const Given &a = run.given.back(), &b = near.given.back();
        double multiplier = 0;
        for (std::size_t k = 0; k < a.lambda.size(); ++k)
          multiplier = std::max(multiplier, std::abs(a.lambda[k] - b.lambda[k]));
        EXPECT_LT(most_apart(a.accelerations, b.accelerations, Matrix3::Identity()),
                  3 * (of_far->acceleration + of_near->acceleration))
            << of_far->index << of_near->index;
        EXPECT_LT(multiplier, 3 * (of_far->multiplier + of_near->multiplier)) << of_far->index << of_near->index;
        ++estimated;
      }
    });
  }
  EXPECT_GE(estimated, 100);
}

}  // namespace
}  // namespace poinsot::test
