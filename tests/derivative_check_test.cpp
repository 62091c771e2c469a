// The derivative check that users see: every model and random ones pass, everything in a model is checked.
#include "formulations/derivative_check.h"

#include <gtest/gtest.h>

#include <set>

#include "core/scene_reader.h"
#include "formulations/registry.h"
#include "tests/scale.h"
#include "tests/support/random_model.h"
#include "tests/support/simulation.h"

namespace poinsot {
namespace {

std::vector<BodyState> start(const Model& model) {
  std::vector<BodyState> states;
  for (const Body& body : model.bodies) {
    BodyState state;
    state.r = body.position, state.A = body.orientation;
    state.rd = body.velocity, state.w = body.angular_velocity;
    states.push_back(state);
  }
  return states;
}

void expect_ok(const Model& model, std::span<const BodyState> states) {
  for (const FormulationEntry& entry : formulations()) {
    const std::vector<DerivativeCheck> checks = entry.check_derivatives(model, states);
    const std::size_t forces = model.springs.size() + model.torsions.size() + model.point_forces.size() +
                               model.torques.size() + model.drags.size();
    EXPECT_EQ(checks.size(), 4 * model.groups.size() + 2 * forces);
    for (const DerivativeCheck& check : checks) {
      EXPECT_TRUE(check.ok) << entry.name << ": " << check.name << ", " << check.what << ": " << check.error;
      EXPECT_LT(check.error, 1e-12) << entry.name << ": " << check.name << ", " << check.what;
    }
  }
}

TEST(DerivativeCheck, PassesOnEveryModel) {
  int models = 0;
  for (const std::string& name : test::model_names()) {
    SCOPED_TRACE(name);
    const Model model = compile(test::scene_of(name));
    expect_ok(model, start(model));
    ++models;
  }
  EXPECT_GE(models, 17);
}

TEST(DerivativeCheck, PassesOnRandomModels) {
  for (int seed = 0; seed < scaled(20); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(static_cast<unsigned>(seed));
    const Model model = test::random_model(random, 3);
    std::vector<BodyState> states(model.bodies.size());
    for (BodyState& state : states) state = random.state();
    expect_ok(model, states);
  }
}

TEST(DerivativeCheck, SpeaksOfThingsByName) {
  test::Random random(1);
  Model model = test::random_bodies(random, 2);
  test::add_row(model, RowType::DP1, 0, 1, random);
  model.groups[0].kind = GroupKind::joint;
  test::add_force(model, test::ForceType::torsion, 0, 1, random);
  model.torsions[0].spring.name = "hinge";
  std::set<std::string> names;
  for (const DerivativeCheck& check : intrinsic_formulation().check_derivatives(model, start(model))) {
    names.insert(check.name + ": " + std::string(check.what));
  }
  EXPECT_EQ(names, (std::set<std::string>{"joint 'DP10': gradient", "joint 'DP10': nu", "joint 'DP10': gamma",
                                          "joint 'DP10': variation of the reaction",
                                          "force 'hinge': variation with the position",
                                          "force 'hinge': variation with the velocity"}));
}

// A right-hand side that has no derivative where the scene starts does not pass as right.
TEST(DerivativeCheck, ReportsWhatIsNotFinite) {
  test::Random random(2);
  Model model = test::random_bodies(random, 2);
  test::add_row(model, RowType::DP1, 0, 1, random);
  model.rows[0].f = Expression::parse("sqrt(t)");
  int failed = 0;
  for (const DerivativeCheck& check : intrinsic_formulation().check_derivatives(model, start(model)))
    failed += !check.ok;
  EXPECT_GT(failed, 0);
}

}  // namespace
}  // namespace poinsot
