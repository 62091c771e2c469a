// Parallel robots against inverse kinematics and the loads of their members, written here: models/stewart_platform
// (started from a rough pose) and models/delta_robot.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "tests/support/signals.h"
#include "tests/support/time_rate.h"

namespace poinsot::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using std::numbers::pi;

Matrix3d about_z(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
}

// ---- Stewart platform: the legs' lengths are those of this motion of the platform.

double heave(double t) {
  return 1 + 0.1 * std::sin(2 * t);
}
double yaw(double t) {
  return 0.3 * std::sin(t);
}

struct Leg {
  Vector3d foot, head;  // on the ground, on the platform
  Vector3d along(double t) const { return Vector3d(0, 0, heave(t)) + about_z(yaw(t)) * head - foot; }
};

Leg leg(int n) {
  const double side = n % 2 == 0 ? -1 : 1, third = 2 * pi / 3 * (n / 2);
  return {about_z(third + side * pi / 12) * Vector3d::UnitX(), about_z(third + side * pi / 4) * Vector3d(0.5, 0, 0)};
}

TEST(StewartPlatform, MovesAsItsLegsWereComputedFor) {
  const Scene scene = scene_of("stewart_platform");
  for (const FormulationEntry& formulation : formulations()) {
    for (const Settings& settings :
         {kinematics(formulation.name, 0.05, 3, 0.25), controlled("dop853", formulation.name, 1e-9, 3, 0.25)}) {
      for (const Snapshot& sample : motion(scene, settings)) {
        const BodyState& platform = sample.bodies[0];
        const double t = sample.t;
        EXPECT_LT((platform.r - Vector3d(0, 0, heave(t))).norm(), 1e-8) << formulation.name << " at " << t;
        EXPECT_LT((platform.A - about_z(yaw(t))).norm(), 1e-8) << formulation.name << " at " << t;
        EXPECT_NEAR(platform.rd.z(), 0.2 * std::cos(2 * t), 1e-7) << formulation.name << " at " << t;
        EXPECT_NEAR(platform.w.z(), 0.3 * std::cos(t), 1e-7) << formulation.name << " at " << t;
        EXPECT_NEAR(platform.rdd.z(), -0.4 * std::sin(2 * t), 1e-6) << formulation.name << " at " << t;
        EXPECT_NEAR(platform.wd.z(), -0.3 * std::sin(t), 1e-6) << formulation.name << " at " << t;
        for (int n = 0; n < 6; ++n) {  // the cylinder lies along the leg, a quarter of a metre from its foot
          const Vector3d along = leg(n).along(t).normalized();
          const BodyState& cylinder = sample.bodies[static_cast<std::size_t>(1 + 2 * n)];
          EXPECT_LT((cylinder.A.col(0) - along).norm(), 1e-8) << n << " at " << t;
          EXPECT_LT((cylinder.r - leg(n).foot - 0.25 * along).norm(), 1e-8) << n << " at " << t;
        }
      }
    }
  }
}

// The platform's own loads are what the legs' heads put on it, whatever the legs weigh: power of the drivers is the
// rate of the energy, here of platform and legs by the closed form of their places.
TEST(StewartPlatform, LegsGiveTheEnergyThatTheMotionTakes) {
  const auto energy = [](double t) {
    const auto turning = [](double J, const Vector3d& along, const Vector3d& along_rate) {
      return 0.5 * J * along.cross(along_rate).squaredNorm();
    };
    double E =
        0.5 * 10 * std::pow(time_rate(heave, t), 2) + 0.5 * 1.2 * std::pow(time_rate(yaw, t), 2) + 10 * 9.81 * heave(t);
    for (int n = 0; n < 6; ++n) {
      const auto u = [&](double s) { return Vector3d(leg(n).along(s).normalized()); };
      const auto cylinder = [&](double s) { return Vector3d(leg(n).foot + 0.25 * u(s)); };
      const auto rod = [&](double s) { return Vector3d(leg(n).foot + leg(n).along(s) - 0.25 * u(s)); };
      const Vector3d du = time_rate(u, t);
      E += 0.5 * time_rate(cylinder, t).squaredNorm() + 9.81 * cylinder(t).z() + turning(0.02, u(t), du);
      E += 0.5 * 0.5 * time_rate(rod, t).squaredNorm() + 0.5 * 9.81 * rod(t).z() + turning(0.01, u(t), du);
      // About its own axis a leg turns with the horizontal crosswise axis of its universal joint.
      const Vector3d y = Vector3d::UnitZ().cross(u(t)).normalized();
      const auto crosswise = [&](double s) { return Vector3d(Vector3d::UnitZ().cross(u(s)).normalized()); };
      const double spin = u(t).dot(y.cross(time_rate(crosswise, t)));
      E += 0.5 * (0.001 + 0.0005) * spin * spin;
    }
    return E;
  };
  const Columns c = signals_of(scene_of("stewart_platform"), kinematics("rA", 0.05, 3, 0.25));
  for (std::size_t k = 0; k < c.at("t").size(); ++k) {
    double power = 0;
    for (int n = 1; n <= 6; ++n) power += c.at(fmt::format("leg {}.power", n))[k];
    EXPECT_NEAR(power, time_rate(energy, c.at("t")[k]), 1e-6) << c.at("t")[k];
  }
}

// ---- Delta robot: the platform hangs from three spheres; what it needs pulls along three rods' directions.

constexpr double kBase = 0.2, kArm = 0.3, kRod = 0.8, kPlate = 0.06, kMass = 0.5, kArmMass = 0.8, kG = 9.81;

double angle(int k, double t) {
  return 0.3 + 0.25 * std::sin(2 * t + k * 2 * pi / 3);
}

Vector3d elbow(int k, double t) {
  const double a = angle(k, t);
  return about_z(k * 2 * pi / 3) * Vector3d(kBase + kArm * std::cos(a), 0, -kArm * std::sin(a));
}

// The lower one of the two points at the rods' length from the elbows, moved inwards by the plate.
Vector3d platform(double t) {
  std::array<Vector3d, 3> c;
  for (int k = 0; k < 3; ++k)
    c[static_cast<std::size_t>(k)] = elbow(k, t) - about_z(k * 2 * pi / 3) * Vector3d(kPlate, 0, 0);
  const Vector3d x = (c[1] - c[0]).normalized();
  const Vector3d z = x.cross(c[2] - c[0]).normalized(), y = z.cross(x);
  const double d = (c[1] - c[0]).norm(), i = x.dot(c[2] - c[0]), j = y.dot(c[2] - c[0]);
  const double px = d / 2, py = (i * i + j * j) / (2 * j) - i / j * px;
  return c[0] + px * x + py * y - std::sqrt(kRod * kRod - px * px - py * py) * z;
}

TEST(DeltaRobot, StandsWhereThreeSpheresMeet) {
  const Scene scene = scene_of("delta_robot");
  for (const FormulationEntry& formulation : formulations()) {
    for (const Settings& settings :
         {kinematics(formulation.name, 0.05, 3, 0.25), controlled("dop853", formulation.name, 1e-9, 3, 0.25)}) {
      for (const Snapshot& sample : motion(scene, settings)) {
        const double t = sample.t;
        EXPECT_LT((sample.bodies[0].r - platform(t)).norm(), 1e-8) << formulation.name << " at " << t;
        EXPECT_LT((sample.bodies[0].A - Matrix3d::Identity()).norm(), 1e-8) << formulation.name << " at " << t;
        EXPECT_LT((sample.bodies[0].rd - time_rate(platform, t)).norm(), 1e-7) << formulation.name << " at " << t;
      }
    }
  }
}

TEST(DeltaRobot, MotorsTurnAgainstTheirArmAndTheirShareOfThePlatform) {
  const auto velocity = [](double t) { return Vector3d(time_rate(platform, t)); };
  const Columns c = signals_of(scene_of("delta_robot"), kinematics("rA", 0.05, 3, 0.25));
  for (std::size_t n = 0; n < c.at("t").size(); ++n) {
    const double t = c.at("t")[n];
    Matrix3d along;  // from elbow to platform, side by side
    for (int k = 0; k < 3; ++k) {
      const Vector3d inwards = about_z(k * 2 * pi / 3) * Vector3d(kPlate, 0, 0);
      along.col(k) = (platform(t) + inwards - elbow(k, t)) / kRod;
    }
    const Vector3d pull = along.partialPivLu().solve(kMass * (time_rate(velocity, t) + kG * Vector3d::UnitZ()));
    for (int k = 0; k < 3; ++k) {
      const auto turn = [&](double s) { return angle(k, s); };
      const auto turn_rate = [&](double s) { return time_rate(turn, s); };
      const Vector3d lever = about_z(k * 2 * pi / 3) *
                             Vector3d(-kArm * std::sin(angle(k, t)), 0, -kArm * std::cos(angle(k, t)));  // ∂elbow/∂θ
      const double moment = kArmMass * kArm * kArm / 3 * time_rate(turn_rate, t) -
                            kArmMass * kG * kArm / 2 * std::cos(angle(k, t)) + pull[k] * along.col(k).dot(lever);
      EXPECT_NEAR(c.at(fmt::format("motor {}.effort", k + 1))[n], moment, 1e-6) << k << " at " << t;
    }
  }
}

}  // namespace
}  // namespace poinsot::test
