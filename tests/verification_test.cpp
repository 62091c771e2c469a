// What verification says of a run, by every integrator in every formulation and in kinematics: how far from a finer
// run, the order of the method, and the error that there is.
#include "bench/study/verification.h"

#include <gmock/gmock.h>

#include <map>
#include <optional>

#include "bench/study/motion.h"
#include "integrators/start/reactions.h"
#include "tests/support/every_way.h"
#include "tests/support/forced_scene.h"
#include "tests/support/loops.h"

namespace poinsot::test {
namespace {

constexpr double kHorizon = 0.2, kInterval = 4e-3;
constexpr const char* kAll[] = {"position",     "orientation",          "velocity",       "angular velocity",
                                "acceleration", "angular acceleration", "reaction force", "reaction moment"};

// By quantity, at every output time of every body or joint.
using Values = std::map<std::string, std::vector<Vector3>>;

struct Followed {
  Values values;
  std::vector<std::vector<Matrix3>> A;
};

Followed follow(const Scene& scene, Settings settings) {
  Followed f;
  std::optional<Reactions> reactions;
  settings.every = kInterval;
  settings.reactions = true;
  const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
    if (!reactions) reactions.emplace(sample.problem);
    reactions->update(sample);
    f.A.emplace_back();
    for (const BodyState& body : snapshot(sample).bodies) {
      f.values["position"].push_back(body.r);
      f.values["velocity"].push_back(body.rd);
      f.values["angular velocity"].push_back(body.w);
      f.values["acceleration"].push_back(body.rdd);
      f.values["angular acceleration"].push_back(body.wd);
      f.A.back().push_back(body.A);
    }
    for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) {
      Vector3 force, moment;
      reactions->of_group(static_cast<int>(joint), force, moment);
      f.values["reaction force"].push_back(force);
      f.values["reaction moment"].push_back(moment);
    }
  });
  EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
  return f;
}

double error_of(const std::string& quantity, const Followed& run, const Followed& exact) {
  double most = 0;
  if (quantity == "orientation") {
    for (std::size_t n = 0; n < run.A.size(); ++n)
      for (std::size_t b = 0; b < run.A[n].size(); ++b)
        most = std::max(most, Eigen::AngleAxisd(Matrix3(run.A[n][b].transpose() * exact.A[n][b])).angle());
    return most;
  }
  const auto &x = run.values.at(quantity), &y = exact.values.at(quantity);
  for (std::size_t k = 0; k < x.size(); ++k) most = std::max(most, (x[k] - y[k]).norm());
  return most;
}

// A motion under way with forces of every kind, and a loop that is let go.
std::vector<Scene> scenes() {
  return {forced(), loop({4, Frames::random, false, false})};
}

TEST(Verification, SaysTheOrderAndTheErrorOfEveryMethod) {
  int unseen = 0;
  for (const Scene& scene : scenes()) {
    const Followed exact = follow(scene, controlled("dop853", "rA", 1e-12, kHorizon));
    const int ways = in_every_way(kInterval, kHorizon, [&](Settings settings) {
      SCOPED_TRACE(scene.name);
      settings.every = 0;
      settings.stopping = Settings{}.stopping;
      settings.tolerance = 1e-9;
      settings.rtol = 1e-7;
      settings.reactions = true;
      const IntegratorEntry& integrator = integrators().require(settings.integrator);
      const study::Verification found = study::verify(scene, settings);
      EXPECT_EQ(found.failure, "");
      EXPECT_EQ(found.steps, !integrator.controls_error);
      std::vector<std::string> names;
      const Followed run = follow(scene, settings);
      for (const auto& q : found.quantities) {
        const std::string& name = names.emplace_back(q.name);
        const double error = error_of(name, run, exact);
        EXPECT_GT(q.apart, 0) << name;
        EXPECT_FALSE(q.where.empty()) << name;
        EXPECT_FALSE(q.unit.empty()) << name;
        if (integrator.controls_error) {
          EXPECT_FALSE(q.order || q.error) << name;
          EXPECT_LT(error, 5 * q.apart) << name;
          continue;
        }
        // Accelerations and reactions of the first step have an error of another kind where the motion is under way,
        // and half-implicit Euler is of second order in plane velocities.
        if (q.order_unseen) {
          EXPECT_TRUE(name != "position" && name != "orientation") << name;
          EXPECT_FALSE(q.order || q.error) << name;
          ++unseen;
          continue;
        }
        ASSERT_TRUE(q.order && q.error) << name;
        EXPECT_GT(*q.order, integrator.order - 0.15) << name;
        EXPECT_LT(*q.order, integrator.order + 1.25) << name;
        if (name == "position" || name == "orientation") {
          EXPECT_LT(*q.order, integrator.order + 0.15) << name;
        }
        const double within = *q.order < integrator.order + 0.5 ? 0.25 : 0.5;
        EXPECT_NEAR(*q.error, error, within * error) << name << " of order " << *q.order;
      }
      EXPECT_THAT(names, ::testing::ElementsAreArray(kAll));
    });
    EXPECT_GE(ways, 25);
  }
  EXPECT_GT(unseen, 0);
}

// Each position is found on its own: no error adds up, and nothing has an order.
TEST(Verification, OfKinematicsIsApartByTheTolerance) {
  for (const FormulationEntry& formulation : formulations()) {
    for (const char* model : {"four_link_joints", "slider_crank_joints"}) {
      for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
        SCOPED_TRACE(fmt::format("{} {} {}", formulation.name, model, tolerance));
        Settings settings = kinematics(formulation.name, 1e-2, 1);
        settings.tolerance = tolerance;
        settings.reactions = true;
        const study::Verification found = study::verify(scene_of(model), settings);
        EXPECT_EQ(found.failure, "");
        EXPECT_EQ(found.against, fmt::format("half the step and a tenth of the tolerance, {:g}", tolerance / 10));
        EXPECT_FALSE(found.steps);
        EXPECT_EQ(found.times, 101u);
        ASSERT_EQ(found.quantities.size(), std::size(kAll));
        for (const auto& q : found.quantities) EXPECT_FALSE(q.order || q.error) << q.name;
        EXPECT_LT(found.quantities[0].apart, tolerance);
        EXPECT_LT(found.quantities[1].apart, 10 * tolerance);
      }
    }
  }
}

}  // namespace
}  // namespace poinsot::test
