// Kinematics of chains of driven hinges, whose motion is known, in steps in which bodies turn far: no hinge is left
// with its axis reversed, no driver half a turn off.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "integrators/integrator.h"
#include "tests/support/random_model.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

struct DrivenChain {
  Scene scene;
  std::vector<Vector3> axis, hinge;  // at the start, global
  std::vector<double> slope, height, frequency;

  explicit DrivenChain(unsigned seed) {
    Random random(seed);
    const int links = random.integer(1, 3);
    for (int k = 0; k < links; ++k) {
      Body link;
      link.name = fmt::format("link{}", k), link.mass = 1, link.inertia = Matrix3::Identity();
      link.position = 2 * random.vector(), link.orientation = random.rotation();
      Joint joint;
      joint.type = JointType::revolute, joint.i = k == 0 ? kGround : k - 1, joint.j = k;
      joint.point = hinge.emplace_back(link.position + random.vector());
      joint.axis = axis.emplace_back(random.unit());
      Driver motor;
      motor.i = joint.i, motor.j = k;
      motor.axis = k == 0 ? axis.back() : Vector3(scene.bodies.back().orientation.transpose() * axis.back());
      slope.push_back(random.uniform(-4, 4)), height.push_back(random.uniform(-5, 5));
      frequency.push_back(random.uniform(1, 6));
      motor.value = Expression::parse(
          fmt::format("{:.17g} * t + {:.17g} * (1 - cos({:.17g} * t))", slope.back(), height.back(), frequency.back()));
      scene.bodies.push_back(link), scene.joints.push_back(joint), scene.drivers.push_back(motor);
    }
  }

  // How far the links are from where their drivers turn them to, m and rad alike.
  double off(const Snapshot& at) const {
    double worst = 0;
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();  // of the link before, from where it was at the start
    for (std::size_t k = 0; k < axis.size(); ++k) {
      const double angle = slope[k] * at.t + height[k] * (1 - std::cos(frequency[k] * at.t));
      moved =
          moved * Eigen::Translation3d(hinge[k]) * Eigen::AngleAxisd(angle, axis[k]) * Eigen::Translation3d(-hinge[k]);
      worst = std::max({worst, (at.bodies[k].r - moved * scene.bodies[k].position).norm(),
                        (at.bodies[k].A - moved.linear() * scene.bodies[k].orientation).norm()});
    }
    return worst;
  }
};

// The largest of what a run is off, if it came to its end.
double off(const DrivenChain& chain, const Settings& settings, Status& status) {
  double worst = 0;
  status = simulate(chain.scene, settings, [&](const Sample& sample) {
             worst = std::max(worst, chain.off(snapshot(sample)));
           }).status;
  return worst;
}

// Of 360 000 such runs these are the seeds of some that once left a link turned over: in reps where angles folded over,
// by a matrix of the position before, where a driver is quick at the start of a step only, and where each turned by
// little but a body, by all of them, did not.
TEST(DrivenTurns, AreFollowedByKinematics) {
  for (const unsigned seed : {494u, 510u, 552u, 605u, 606u, 650u, 852u, 1148u, 1242u, 1403u, 7744u, 15673u})
    for (const FormulationEntry& formulation : formulations())
      for (const JacobianEntry& jacobian : jacobians()) {
        const DrivenChain chain(seed);
        Settings settings = kinematics(formulation.name, seed % 2 ? 0.1 : 0.2, 2);
        settings.jacobian = jacobian.name;
        Status status;
        EXPECT_LT(off(chain, settings, status), 1e-8) << seed << " " << formulation.name << " " << jacobian.name;
        EXPECT_TRUE(status.ok()) << status.message;
      }
}

// Stabilized index 2 displaces positions besides what velocities do.
TEST(DrivenTurns, AreFollowedByFixedStepsOrEndThem) {
  int followed = 0;
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
    for (const unsigned seed : {2u, 25u, 49u, 134u, 425u, 480u, 516u, 525u, 829u, 1110u})
      for (const FormulationEntry& formulation : formulations()) {
        const DrivenChain chain(seed);
        Settings settings;
        settings.formulation = formulation.name, settings.integrator = integrator.name;
        settings.step = std::array{0.1, 0.05, 0.02, 0.01}[seed % 4];
        settings.end = 0.6, settings.every = 0.1, settings.tolerance = 1e-8;
        Status status;
        EXPECT_LT(off(chain, settings, status), 1e-6) << seed << " " << formulation.name << " " << integrator.name;
        if (status.ok())
          ++followed;
        else
          EXPECT_THAT(status.message, ::testing::HasSubstr("try ")) << seed << " " << integrator.name;
      }
  }
  EXPECT_GE(followed, 50);
}

}  // namespace
}  // namespace poinsot::test
