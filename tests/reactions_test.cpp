// Reactions: statics by hand, the torque of a driver, Newton's and Euler's equations of every body with the reactions
// of its joints, sharing where joints are redundant, and the multipliers of the reference.
#include "integrators/start/reactions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <ctime>
#include <functional>
#include <memory>
#include <numbers>

#include "core/scene_generator.h"
#include "tests/support/loops.h"
#include "tests/support/scene_transform.h"

namespace poinsot::test {
namespace {

struct Wrench {
  Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
};

// Calls `look` with every sample and the reactions there.
void with_reactions(const Scene& scene, Settings settings,
                    const std::function<void(const Sample&, const Reactions&)>& look) {
  settings.reactions = true;
  std::unique_ptr<Reactions> reactions;
  int samples = 0;
  const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
    if (!reactions) reactions = std::make_unique<Reactions>(sample.problem);
    reactions->update(sample);
    look(sample, *reactions);
    ++samples;
  });
  EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
  EXPECT_GT(samples, 0);
}

Wrench wrench(const Reactions& reactions, int group) {
  Wrench w;
  reactions.of_group(group, w.force, w.moment);
  return w;
}

void expect_near(const Vector3& x, const Vector3& expected, double tolerance, const std::string& which) {
  EXPECT_LT((x - expected).norm(), tolerance)
      << which << ": " << x.transpose() << " instead of " << expected.transpose();
}

// A body hung askew, its centre away from the joint.
Scene hanging(JointType type) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  Body& body = scene.bodies.emplace_back();
  body.name = "body";
  body.mass = 3;
  body.inertia = Vector3(1, 2, 2.5).asDiagonal();
  body.position = {0.4, -0.3, 1};
  body.orientation = Eigen::AngleAxisd(0.8, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  Joint& joint = scene.joints.emplace_back();
  joint.name = "hook";
  joint.type = type;
  joint.j = 0;
  joint.point = {0.1, 0.2, 2};
  joint.axis = Vector3::UnitZ();
  return scene;
}

class ReactionForces : public ::testing::TestWithParam<std::string> {};

TEST_P(ReactionForces, TheJointBearsTheWeight) {
  for (bool exchanged : {false, true}) {
    Scene scene = hanging(JointType::fixed);
    if (exchanged) std::swap(scene.joints[0].i, scene.joints[0].j);
    const Vector3 weight(0, 0, -3 * 9.81), arm = scene.bodies[0].position - scene.joints[0].point;
    with_reactions(scene, kinematics(GetParam(), 0.1, 0.2), [&](const Sample&, const Reactions& reactions) {
      const Wrench w = wrench(reactions, 0);  // on body j: the body, or with the bodies exchanged the ground
      const double sign = exchanged ? -1 : 1;
      expect_near(sign * w.force, -weight, 1e-10, GetParam());
      expect_near(sign * w.moment, -arm.cross(weight), 1e-10, GetParam());
    });
  }
}

// Standing on a vertical axis the body is in equilibrium: the joint bears all but a moment about its axis.
TEST_P(ReactionForces, ARevoluteJointOnAVerticalAxis) {
  const Scene scene = hanging(JointType::revolute);
  const Vector3 weight(0, 0, -3 * 9.81), arm = scene.bodies[0].position - scene.joints[0].point;
  with_reactions(scene, dynamics(GetParam(), 1e-2, 0.1), [&](const Sample& sample, const Reactions& reactions) {
    const Wrench w = wrench(reactions, 0);
    expect_near(w.force, -weight, 1e-8, fmt::format("{} at {}", GetParam(), sample.t));
    expect_near(w.moment, -arm.cross(weight), 1e-8, fmt::format("{} at {}", GetParam(), sample.t));
  });
}

// Two hinges on a vertical axis, above and below the centre: 5 of the 10 rows are set aside, and still both bear alike.
TEST_P(ReactionForces, TwoHingesShareTheLoad) {
  Scene scene = hanging(JointType::revolute);
  const Vector3 centre = scene.bodies[0].position, arm(0.3, -0.5, 0);
  scene.joints.push_back(scene.joints[0]);
  scene.joints[0].point = centre - arm + Vector3(0, 0, 0.7);
  scene.joints[1].point = centre - arm - Vector3(0, 0, 0.7);
  scene.joints[1].name = "lower hook";
  const Vector3 weight(0, 0, -3 * 9.81);
  Settings settings = dynamics(GetParam(), 1e-2, 0.1);
  EXPECT_FALSE(simulate(scene, settings, nullptr).undetermined_reactions.empty());
  with_reactions(scene, settings, [&](const Sample&, const Reactions& reactions) {
    const Wrench upper = wrench(reactions, 0), lower = wrench(reactions, 1);
    expect_near(upper.force + lower.force, -weight, 1e-8, GetParam());
    EXPECT_NEAR(upper.force.z(), lower.force.z(), 1e-8) << GetParam();
    expect_near(upper.moment, lower.moment, 1e-8, GetParam());
    const Vector3 about_centre = upper.moment + lower.moment + (scene.joints[0].point - centre).cross(upper.force) +
                                 (scene.joints[1].point - centre).cross(lower.force);
    expect_near(about_centre, Vector3::Zero(), 1e-8, GetParam());
    EXPECT_GT(std::abs(upper.force.x() - lower.force.x()), 1);  // the couple that the weight asks for
  });
}

// Inverse dynamics by hand: M = (J + m l²) θ̈ + m g l cos θ about the axis, θ = −π/2 + (π/4) cos 2t.
TEST_P(ReactionForces, TheDriverGivesTheTorque) {
  using std::numbers::pi;
  const Scene scene = scene_of("single_pendulum_joints");
  with_reactions(scene, kinematics(GetParam(), 1e-2, 1), [&](const Sample& sample, const Reactions& reactions) {
    const double theta = -pi / 2 + pi / 4 * std::cos(2 * sample.t), acceleration = -pi * std::cos(2 * sample.t);
    const double torque = (104.01625 + 78 * 4) * acceleration + 78 * 9.81 * 2 * std::cos(theta);
    const Wrench driver = wrench(reactions, 1);
    expect_near(driver.moment, {torque, 0, 0}, 1e-8, fmt::format("{} at {}", GetParam(), sample.t));
    expect_near(driver.force, Vector3::Zero(), 1e-10, GetParam());
  });
}

// Newton's and Euler's equations of every body with the reactions of its groups. Forces between bodies act at one point
// of both (the group's on body j), as do those of joints.
void expect_balance(const Scene& scene, const Settings& settings, bool whole_run) {
  const Model model = compile(scene);
  with_reactions(scene, settings, [&](const Sample& sample, const Reactions& reactions) {
    if (sample.t > 0 && !whole_run) return;
    std::vector<BodyState> states(model.bodies.size());
    sample.problem.to_bodies(sample.a, states);
    std::vector<Wrench> rest(model.bodies.size());  // inertia and weight, to be borne by the reactions
    double size = 0;
    for (std::size_t b = 0; b < states.size(); ++b) {
      const BodyState& x = states[b];
      const Matrix3& J = model.bodies[b].inertia;
      rest[b].force = model.bodies[b].mass * (x.rdd - model.gravity);
      rest[b].moment = x.A * (J * x.wd + x.w.cross(J * x.w));
      size = std::max({size, rest[b].force.norm(), rest[b].moment.norm()});
    }
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      const Group& group = model.groups[g];
      const Wrench w = wrench(reactions, static_cast<int>(g));
      size = std::max({size, w.force.norm(), w.moment.norm()});
      const auto at = [&](int b) { return states[static_cast<std::size_t>(b)]; };
      const Vector3 point = group.j == kGround ? group.point_j : Vector3(at(group.j).r + at(group.j).A * group.point_j);
      const auto bear = [&](int b, double sign) {
        if (b == kGround) return;
        rest[static_cast<std::size_t>(b)].force -= sign * w.force;
        rest[static_cast<std::size_t>(b)].moment -= sign * (w.moment + (point - at(b).r).cross(w.force));
      };
      bear(group.j, 1);
      bear(group.i, -1);
    }
    for (std::size_t b = 0; b < rest.size(); ++b) {
      const std::string which =
          fmt::format("{} {} at {}, {}", scene.name, settings.formulation, sample.t, model.bodies[b].name);
      EXPECT_LT(rest[b].force.norm(), 1e-9 * size) << which;
      EXPECT_LT(rest[b].moment.norm(), 1e-9 * size) << which;
    }
  });
}

TEST_P(ReactionForces, DrivenMechanismsBalance) {
  for (const char* model : {"single_pendulum", "single_pendulum_joints", "four_link", "four_link_haug",
                            "four_link_joints", "slider_crank_joints"}) {
    expect_balance(scene_of(model), kinematics(GetParam(), 1e-2, 1, 0.1), true);
  }
}

TEST_P(ReactionForces, FreeMechanismsBalanceAtTheStart) {
  for (const char* model : {"double_pendulum", "heavy_top", "double_four_bar", "knife_edge"}) {
    expect_balance(scene_of(model), dynamics(GetParam(), 1e-4, 1e-4), false);
  }
}

// Of all multipliers that bear the same, those given are the least.
TEST_P(ReactionForces, RedundantReactionsAreTheLeast) {
  const Scene scene = scene_of("double_four_bar");
  const auto rows = static_cast<int>(compile(scene).rows.size());
  with_reactions(scene, dynamics(GetParam(), 1e-3, 0.1, 0.05), [&](const Sample& sample, const Reactions& reactions) {
    double least = 0, plain = 0;
    for (int row = 0; row < rows; ++row) least += std::pow(reactions.lambda(row), 2);
    for (std::size_t k = 0; k < sample.problem.model_rows().size(); ++k) plain += std::pow(sample.lambda[k], 2);
    EXPECT_LT(least, plain * (1 + 1e-12)) << sample.t;
    // the planar load does not press any link out of the plane
    for (int group = 0; group < 7; ++group) EXPECT_NEAR(wrench(reactions, group).force.z(), 0, 1e-8) << sample.t;
  });
}

// The plane of a chain kept once more: the reactions of 300 bodies cost about what a step does, not the cube of them.
TEST(RedundantReactions, OfALongChainAreFoundSparsely) {
  Scene scene = find_scene_generator("chain")->make(300);
  Constraint& again = scene.constraints.emplace_back();
  again.name = "again";
  again.type = ConstraintType::CD;
  again.j = 0;
  again.c = Vector3::UnitX();
  Settings settings = dynamics("rA", 1e-3, 0.01);
  const auto seconds = [](const auto& act) {
    const std::clock_t began = std::clock();
    act();
    return static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  };
  const double alone = seconds([&] { EXPECT_TRUE(simulate(scene, settings, [](const Sample&) {}).status.ok()); });
  int samples = 0;
  const double with = seconds([&] {
    with_reactions(scene, settings, [&](const Sample& sample, const Reactions&) {
      EXPECT_LT(sample.problem.model_rows().size(), sample.problem.model().rows.size()) << "no row is redundant";
      ++samples;
    });
  });
  EXPECT_EQ(samples, 11);
  EXPECT_LT(with, 6 * alone) << "a dense decomposition takes a second for every sample";
}

// Upright and at rest the double four-bar is its own mirror image, and so are the least reactions.
TEST_P(ReactionForces, RedundantReactionsAreSymmetric) {
  Scene scene = scene_of("double_four_bar");
  for (Body& body : scene.bodies) body.velocity.setZero(), body.angular_velocity.setZero();
  with_reactions(scene, dynamics(GetParam(), 1e-3, 1e-3), [&](const Sample& sample, const Reactions& reactions) {
    if (sample.t > 0) return;
    EXPECT_NEAR(wrench(reactions, 0).force.y(), wrench(reactions, 2).force.y(), 1e-8);
    EXPECT_NEAR(wrench(reactions, 3).force.y(), wrench(reactions, 6).force.y(), 1e-8);
    double borne = 0;
    for (int group = 0; group < 3; ++group) borne += wrench(reactions, group).force.y();
    EXPECT_NEAR(borne, 5 * 9.81, 1e-8);
  });
}

// Multipliers by inverse dynamics in kinematics are those of the reference.
TEST_P(ReactionForces, InverseDynamicsIsTheReference) {
  for (const char* mechanism : {"single_pendulum", "four_link", "slider_crank"}) {
    const Scene scene = scene_of(mechanism);
    const Table table = reference_table(std::string("lambda_") + mechanism);
    double largest = 0, error = 0;
    with_reactions(scene, kinematics(GetParam(), 1e-2, 3, 0.1), [&](const Sample& sample, const Reactions& reactions) {
      const auto& reference = table.rows[static_cast<std::size_t>(std::lround(sample.t / 0.1))];
      for (std::size_t k = 0; k < scene.constraints.size(); ++k) {
        const double lambda = std::stod(reference[k + 2]);
        const bool alternate = std::abs(scene.constraints[k].f.at(sample.t).f) > 0.9;
        if (scene.constraints[k].alternate && alternate != (reference[1] == "alt")) continue;
        largest = std::max(largest, std::abs(lambda));
        error = std::max(error, std::abs(reactions.lambda(static_cast<int>(k)) - lambda));
      }
    });
    EXPECT_LT(error, 1e-9 * largest) << mechanism << ' ' << GetParam();
  }
}

INSTANTIATE_TEST_SUITE_P(All, ReactionForces, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// Forces along the hinges' axis and moments across it, wherever the axis has turned to.
TEST(Reactions, AreSaidToBeUndeterminedOfEverySample) {
  const Scene scene = loop({4, Frames::random, true, true});
  std::vector<BodyState> bodies(scene.bodies.size());
  int turned = 0;
  with_reactions(scene, dynamics("rA", 2e-3, 1), [&](const Sample& sample, const Reactions& reactions) {
    sample.problem.to_bodies(sample.a, bodies);
    const Vector3 axis = bodies[0].A * Vector3::UnitZ();
    std::array<bool, 6> expected{};
    for (int c = 0; c < 3; ++c) {
      const double along = std::abs(axis[c]), across = Vector3::Unit(c).cross(axis).norm();
      for (const double part : {along, across})
        if (part > 1e-9 && part < 1e-4) return;
      expected[index(c)] = along > 1e-4;
      expected[index(3 + c)] = across > 1e-4;
    }
    turned += expected == std::array{true, false, true, true, true, true};
    const std::vector<Undetermined> found = reactions.undetermined();
    ASSERT_EQ(found.size(), 4u) << sample.t;
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].group, static_cast<int>(k) + 1);  // all but the hinge of the base
      EXPECT_EQ(found[k].loaded, expected) << sample.t;
    }
  });
  EXPECT_GT(turned, 400);
}

}  // namespace
}  // namespace poinsot::test
