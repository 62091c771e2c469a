// Forces and drivers that the program computes which builds the scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/input_error.h"
#include "core/saved_scene.h"
#include "core/so3.h"
#include "formulations/derivative_check.h"
#include "formulations/registry.h"
#include "tests/support/allocations.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

// Two bodies in the air, the first drawn to the second's centre by a point of its own and turned by drag.
constexpr double kStiffness = 80, kTranslational = 0.6, kRotational = 0.3;
const Vector3 kPoint(0.3, -0.2, 0.1);

Scene two_bodies() {
  return parse_scene(R"j({"scene": 1, "name": "two", "gravity": [0, 0, -9.81], "bodies": [
    {"name": "box", "mass": 2, "inertia": [0.2, 0.3, 0.1], "position": [0.3, 0.1, -1.2], "velocity": [0.5, 0, 0.2],
      "angular_velocity": [0.3, 1, 0.1]},
    {"name": "disc", "mass": 1, "inertia": [0.05, 0.05, 0.1], "position": [0.3, 0.9, -1.7]}]})j",
                     "two.json");
}

Scene with_elements() {
  Scene scene = two_bodies();
  Spring spring;
  spring.i = 0, spring.j = 1, spring.s_i = kPoint, spring.stiffness = kStiffness;
  LinearDrag drag;
  drag.body = 0, drag.translational = kTranslational, drag.rotational = kRotational;
  scene.forces = {spring, drag};
  return scene;
}

Vector3 pull(std::span<const BodyState> at) {
  return -kStiffness * (at[0].r + at[0].A * kPoint - at[1].r);
}

// The same by vector algebra.
Scene with_callback(bool with_sensitivity) {
  Scene scene = two_bodies();
  CallbackForce force;
  force.name = "bond";
  force.bodies = {0, 1};
  force.loads = [](double, std::span<const BodyState> at, std::span<Load> loads) {
    const Vector3 f = pull(at);
    loads[0].force = f - kTranslational * at[0].rd;
    loads[0].torque = kPoint.cross(at[0].A.transpose() * f) - kRotational * at[0].w;
    loads[1].force = -f;
  };
  if (with_sensitivity)
    force.sensitivity = [](double, std::span<const BodyState> at, LoadSensitivity& by) {
      const Matrix3 one = Matrix3::Identity(), arm = tilde<double>(kPoint), A = at[0].A;
      Eigen::Matrix<double, 3, 12> f = Eigen::Matrix<double, 3, 12>::Zero();
      f.leftCols<3>() = -kStiffness * one;
      f.middleCols<3>(3) = kStiffness * A * arm;
      f.middleCols<3>(6) = kStiffness * one;
      by.position.topRows<3>() = f;
      by.position.middleRows<3>(3) = arm * A.transpose() * f;
      by.position.block<3, 3>(3, 3) += arm * tilde<double>(Vector3(A.transpose() * pull(at)));
      by.position.middleRows<3>(6) = -f;
      by.velocity.block<3, 3>(0, 0) = -kTranslational * one;
      by.velocity.block<3, 3>(3, 3) = -kRotational * one;
    };
  scene.forces = {force};
  return scene;
}

// A spring of length 0 pulls along its span and is smooth everywhere: what the callback computes, by another way. In rp
// the two differ in the part along p, which the multiplier of the normalization takes up, and a stabilized method sees
// that: by a small part of its own error, which a run of half the step shows.
TEST(Callback, is_the_element_it_computes_in_every_formulation_and_integrator) {
  for (const std::string& formulation : formulation_names()) {
    for (const IntegratorEntry& integrator : integrators()) {
      if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, formulation)) continue;
      Settings settings = controlled(integrator.name, formulation, 1e-9, 0.5, 0.1);
      settings.step = 0.005;
      settings.tolerance = 1e-10;
      const std::vector<Snapshot> expected = motion(with_elements(), settings);
      double allowed = 2e-7;
      if (formulation == "rp" && !integrator.controls_error) {
        Settings half = settings;
        half.step /= 2;
        allowed += 0.01 * distance(motion(with_elements(), half), expected).largest();
      }
      for (const bool with_sensitivity : {true, false}) {
        const Distance off = distance(motion(with_callback(with_sensitivity), settings), expected);
        EXPECT_LT(off.largest(), allowed) << integrator.name << " in " << formulation << ": " << off;
      }
    }
  }
}

TEST(Callback, costs_no_newton_iteration_and_no_allocation_in_a_step) {
  Settings settings;
  settings.integrator = "implicit_euler";
  const auto iterations = [&](const Scene& scene) {
    return static_cast<double>(run(scene, settings).outcome.statistics.newton_iterations);
  };
  const double elements = iterations(with_elements());
  EXPECT_NEAR(iterations(with_callback(true)), elements, 0.01 * elements);
  EXPECT_NEAR(iterations(with_callback(false)), elements, 0.05 * elements);
  for (const bool with_sensitivity : {true, false}) {
    const Scene scene = with_callback(with_sensitivity);
    for (const char* integrator : {"implicit_euler", "dop853", "radau5"}) {
      settings.integrator = integrator;
      settings.linear_solver = "dense";  // klu allocates fresh pivots
      std::vector<long> counts;
      counts.reserve(100000);
      const Outcome outcome = simulate(scene, settings, [&](const Sample&) { counts.push_back(allocations()); });
      ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
      EXPECT_EQ(counts[counts.size() - 2], counts[counts.size() / 2]) << integrator;
    }
  }
}

TEST(Callback, sensitivities_are_checked) {
  const auto checked = [](const Scene& scene) {
    const Model model = compile(scene);
    std::vector<BodyState> states(2);
    for (std::size_t b = 0; b < 2; ++b) {
      states[b].r = model.bodies[b].position;
      states[b].A = exp_so3<double>(Vector3(0.3, -0.8, 1.1 + static_cast<double>(b)));
      states[b].rd = Vector3(0.2, 0.4, -0.1), states[b].w = Vector3(0.7, -0.2, 0.5);
    }
    std::vector<DerivativeCheck> all;
    for (const FormulationEntry& formulation : formulations())
      for (const DerivativeCheck& check : formulation.check_derivatives(model, states)) all.push_back(check);
    return all;
  };
  const std::vector<DerivativeCheck> right = checked(with_callback(true));
  EXPECT_EQ(right.size(), 9u);
  for (const DerivativeCheck& check : right) {
    EXPECT_TRUE(check.ok) << check.name << ", " << check.what << ": " << check.error;
    EXPECT_LT(check.error, check.what == "sensitivity" ? 1e-6 : 1e-12) << check.name << ", " << check.what;
  }
  for (const DerivativeCheck& check : checked(with_callback(false)))
    EXPECT_TRUE(check.ok) << check.name << ", " << check.what << ": " << check.error;
  Scene wrong = with_callback(true);
  auto& force = std::get<CallbackForce>(wrong.forces[0]);
  force.sensitivity = [right_one = force.sensitivity](double t, std::span<const BodyState> at, LoadSensitivity& by) {
    right_one(t, at, by);
    by.position(4, 5) = 0;
  };
  int found = 0;
  for (const DerivativeCheck& check : checked(wrong)) found += !check.ok && check.what == "sensitivity";
  EXPECT_EQ(found, 3);
}

TEST(Callback, drivers_move_as_their_expressions_do) {
  Scene scene = scene_of("four_link_joints");
  ASSERT_FALSE(scene.drivers.empty());
  const Expression expression = scene.drivers[0].value;
  const auto jets = Expression::function([expression](double t) { return expression.at(t); });
  const auto values = Expression::function([expression](double t) { return expression.at(t).f; });
  EXPECT_TRUE(jets.is_function() && !expression.is_function());
  for (const double t : {0.0, 0.3, 2.0}) {
    EXPECT_NEAR(values.at(t).fd, expression.at(t).fd, 1e-11 * (1 + std::abs(expression.at(t).fd)));
    EXPECT_NEAR(values.at(t).fdd, expression.at(t).fdd, 1e-8 * (1 + std::abs(expression.at(t).f)));
  }
  for (const std::string& formulation : formulation_names()) {
    for (const Settings& settings :
         {kinematics(formulation, 0.01, 0.3), controlled("dop853", formulation, 1e-9, 0.3, 0.1)}) {
      scene.drivers[0].value = expression;
      const std::vector<Snapshot> expected = motion(scene, settings);
      scene.drivers[0].value = jets;
      EXPECT_LT(distance(motion(scene, settings), expected).largest(), 1e-12);
      scene.drivers[0].value = values;
      EXPECT_LT(distance(motion(scene, settings), expected).largest(), 1e-7);
    }
  }
}

std::string refusal(const std::function<void()>& what) {
  try {
    what();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Callback, what_is_wrong_is_said) {
  Scene scene = with_callback(true);
  const auto compiled = [&] { (void)compile(scene); };
  const std::vector<BodyState> states(2);
  EXPECT_EQ(refusal([&] { (void)saved_scene(scene, 0, states, {}); }),
            "/forces/0: found a function of the program, expected what a scene file can hold");
  auto& force = std::get<CallbackForce>(scene.forces[0]);
  force.bodies = {0, 0};
  EXPECT_THAT(refusal(compiled), testing::HasSubstr("found 0 twice, expected different bodies"));
  force.bodies = {0, kGround};
  EXPECT_THAT(refusal(compiled), testing::HasSubstr("found -1, expected the number of a body, less than 2"));
  force.bodies = {};
  EXPECT_THAT(refusal(compiled), testing::HasSubstr("found none, expected at least one body"));
  force.bodies = {0, 1};
  force.loads = nullptr;
  EXPECT_THAT(refusal(compiled), testing::HasSubstr("found no function, expected one"));
  force.loads = [](double t, std::span<const BodyState>, std::span<Load> loads) { loads[1].force.x() = 1 / (0.3 - t); };
  force.sensitivity = nullptr;
  Settings settings;
  settings.integrator = "implicit_euler";
  settings.step = 0.1;
  const Status status = run(scene, settings).outcome.status;
  EXPECT_EQ(status.failure, Failure::not_finite);
  EXPECT_THAT(status.message, testing::HasSubstr("force 'bond' (/forces/0): "));
  EXPECT_THAT(status.message, testing::HasSubstr("its function gave a load that is not finite"));
  Spring spring;
  spring.i = 0, spring.j = 1, spring.law = Expression::function([](double t) { return t; });
  scene.forces = {spring};
  EXPECT_THAT(refusal(compiled), testing::HasSubstr("found a function of time, expected an expression"));
}

}  // namespace
}  // namespace poinsot::test
