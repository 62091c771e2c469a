// Reactions that redundant rows leave open where two forces have a moment together, of CD and pfaffian rows between
// moving bodies: they are in balance and the least.
#include <gmock/gmock.h>

#include <memory>
#include <optional>

#include "integrators/start/reactions.h"
#include "tests/support/grounded_scenes.h"

namespace poinsot::test::grounded {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class GroundedReactions : public ::testing::TestWithParam<std::string> {
 protected:
  // Newton's and Euler's equations of every body, forces of constraints at their own two points; of all multipliers
  // that do the same the least. Looks at every sample.
  static void expect_least_in_balance(const Scene& scene, double end) {
    const Model model = compile(scene);
    std::optional<Reactions> reactions;
    Settings settings = dynamics(GetParam(), 1e-3, end);
    settings.integrator = "dopri5";
    settings.rtol = 1e-10;
    settings.reactions = true;
    const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
      if (!reactions) reactions.emplace(sample.problem);
      reactions->update(sample);
      EXPECT_TRUE(reactions->least());
      expect_balance(model, sample, *reactions);
      expect_least(model, sample, *reactions);
    });
    EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
    EXPECT_THAT(outcome.notices, Not(::testing::Contains(HasSubstr("the least"))));
  }

  static void expect_balance(const Model& model, const Sample& sample, const Reactions& reactions) {
    std::vector<BodyState> states(model.bodies.size());
    sample.problem.to_bodies(sample.a, states);
    std::vector<Vector3> force(states.size()), moment(states.size());
    for (std::size_t b = 0; b < states.size(); ++b) {
      const BodyState& x = states[b];
      const Matrix3& J = model.bodies[b].inertia;
      force[b] = model.bodies[b].mass * (x.rdd - model.gravity);
      moment[b] = x.A * (J * x.wd + x.w.cross(J * x.w));
    }
    const auto at = [&](int b) { return states[static_cast<std::size_t>(b)]; };
    const auto place = [&](int b, const Vector3& s) { return b == kGround ? s : Vector3(at(b).r + at(b).A * s); };
    double size = 1;
    const auto bear = [&](int b, const Vector3& point, const Vector3& f, const Vector3& n) {
      if (b == kGround) return;
      force[static_cast<std::size_t>(b)] -= f;
      moment[static_cast<std::size_t>(b)] -= n + (point - at(b).r).cross(f);
      size = std::max({size, f.norm(), n.norm()});
    };
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      const Group& group = model.groups[g];
      const Row& row = model.rows[static_cast<std::size_t>(group.first_row)];
      Vector3 f, n;
      reactions.of_group(static_cast<int>(g), f, n);
      const Vector3 on_j = place(group.j, group.point_j);
      bear(group.j, on_j, f, n);
      bear(group.i, group.kind == GroupKind::constraint ? place(row.i, row.s_i) : on_j, -f, -n);
    }
    for (std::size_t b = 0; b < states.size(); ++b) {
      EXPECT_LT(force[b].norm(), 1e-9 * size) << sample.t << ", body " << b;
      EXPECT_LT(moment[b].norm(), 1e-9 * size) << sample.t << ", body " << b;
    }
  }

  static void expect_least(const Model& model, const Sample& sample, const Reactions& reactions) {
    std::vector<BodyState> states(model.bodies.size());
    sample.problem.to_bodies(sample.a, states);
    const RowSpace all = all_rows(std::make_shared<const Model>(model), sample.t, states);
    Eigen::MatrixXd G_t(all.columns());
    Eigen::VectorXd lambda(G_t.cols());
    for (Eigen::Index k = 0; k < lambda.size(); ++k) {
      G_t.col(k) *= all.lengths()[static_cast<std::size_t>(k)];
      lambda[k] = reactions.lambda(static_cast<int>(k));
    }
    EXPECT_LT((Dense::of(std::move(G_t)).null.transpose() * lambda).norm(), 1e-7 * (1 + lambda.norm())) << sample.t;
  }
};

// By hand: the row and the weld share the 20 N so that λ² + fz² + ny² is the least.
TEST_P(GroundedReactions, OfAWeldThatIsHeldOnceMore) {
  Settings settings = dynamics(GetParam(), 1e-2, 1e-2);
  settings.reactions = true;
  (void)simulate(welded(ConstraintType::CD), settings, [&](const Sample& sample) {
    Reactions reactions(sample.problem);
    reactions.update(sample);
    Vector3 force, moment;
    reactions.of_group(2, force, moment);
    EXPECT_NEAR(reactions.lambda(0), -15, 1e-9);
    EXPECT_NEAR(force.z(), 5, 1e-9);
    EXPECT_NEAR(moment.y(), -5, 1e-9);
  });
}

TEST_P(GroundedReactions, BalanceEveryBody) {
  for (const ConstraintType type : {ConstraintType::CD, ConstraintType::pfaffian}) {
    expect_least_in_balance(welded(type), 1e-2);
    expect_least_in_balance(double_pendulum(type), 1);
  }
}

TEST_P(GroundedReactions, BalanceEveryBodyOfRandomScenes) {
  for_random_scenes([](const Scene& scene, const Analyzed&) { expect_least_in_balance(scene, 1e-3); });
}

INSTANTIATE_TEST_SUITE_P(All, GroundedReactions, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace poinsot::test::grounded
