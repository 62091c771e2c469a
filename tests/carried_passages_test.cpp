// A planar loop of five links on a body that turns, both cranks driven so that its tip goes straight through the place
// where the rods are in line, at the end of a step. Three rows are redundant everywhere, and a fourth there.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/so3.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr double kCrankLength = 0.5, kRodLength = 1, kTipSpeed = 0.4, kInLine = 0.5;  // m, m, m/s, s

// Of a link of the loop in the carrier's plane.
struct CarriedLink {
  double x, y, angle;
};

class CarriedLoop {
 public:
  CarriedLoop(double course, double turns)
      : course_(course), turns_(turns) {}  // rad of the tip's way; rad/s of the carrier

  // Crank and rod of the left side and of the right one.
  std::vector<CarriedLink> links(double t) const {
    std::vector<CarriedLink> all;
    const double tip_x = kTipSpeed * (t - kInLine) * std::cos(course_),
                 tip_y = kTipSpeed * (t - kInLine) * std::sin(course_);
    for (const double side : {-1.0, 1.0}) {
      const double dx = tip_x - side, dy = tip_y + kCrankLength, d = std::hypot(dx, dy);
      const double crank =
          std::atan2(dy, dx) -
          side * std::acos((kCrankLength * kCrankLength - kRodLength * kRodLength + d * d) / (2 * kCrankLength * d));
      const double x = side + kCrankLength * std::cos(crank), y = -kCrankLength + kCrankLength * std::sin(crank);
      all.push_back({(side + x) / 2, (y - kCrankLength) / 2, crank});
      all.push_back({(x + tip_x) / 2, (y + tip_y) / 2, std::atan2(tip_y - y, tip_x - x)});
    }
    return all;
  }

  Vector3 place(const CarriedLink& link, double t) const {
    return exp_so3<double>(Vector3(0, turns_ * t, 0)) * Vector3(link.x, link.y, 0);
  }

  Scene scene() const {
    constexpr double h = 1e-5;
    Scene scene;
    add_body(scene, "carrier", Vector3::Zero(), Matrix3::Identity(), Vector3::Zero(), {0, turns_, 0});
    const std::vector<CarriedLink> now = links(0), before = links(-h), after = links(h);
    const char* const names[] = {"crank1", "rod1", "crank2", "rod2"};
    for (std::size_t k = 0; k < now.size(); ++k) {
      const Matrix3 A = exp_so3<double>(Vector3(0, 0, now[k].angle));
      const Vector3 v = (place(after[k], h) - place(before[k], -h)) / (2 * h);
      const Vector3 w = Vector3(0, turns_, 0) + Vector3(0, 0, (after[k].angle - before[k].angle) / (2 * h));
      add_body(scene, names[k], place(now[k], 0), A, v, A.transpose() * w);
    }
    add_hinge(scene, kGround, 0, Vector3::Zero(), Vector3::UnitY());
    for (const int side : {0, 1}) {
      const CarriedLink &crank = now[index(2 * side)], &rod = now[index(2 * side + 1)];
      add_hinge(scene, 0, 1 + 2 * side, {side == 0 ? -1.0 : 1.0, -kCrankLength, 0}, Vector3::UnitZ());
      add_hinge(scene, 1 + 2 * side, 2 + 2 * side, end_of(crank, kCrankLength), Vector3::UnitZ());
      if (side == 1) add_hinge(scene, 2, 4, end_of(rod, kRodLength), Vector3::UnitZ());
    }
    add_motor(scene, kGround, 0, Vector3::UnitY(), fmt::format("{}*t", turns_));
    for (const int side : {0, 1}) {
      const std::string d = fmt::format("{}*(t - {})", kTipSpeed, kInLine), s = side == 0 ? "(-1)" : "1";
      const std::string dx = fmt::format("({}*{} - {})", d, std::cos(course_), s);
      const std::string dy = fmt::format("({}*{} + {})", d, std::sin(course_), kCrankLength);
      const std::string square = fmt::format("({0}^2 + {1}^2)", dx, dy);
      add_motor(scene, 0, 1 + 2 * side, Vector3::UnitZ(),
                fmt::format("atan2({}, {}) - {}*acos(({} + {})/({}*sqrt({}))) - ({})", dy, dx, s,
                            kCrankLength * kCrankLength - kRodLength * kRodLength, square, 2 * kCrankLength, square,
                            now[index(2 * side)].angle));
    }
    return scene;
  }

 private:
  static Vector3 end_of(const CarriedLink& link, double length) {
    return {link.x + length / 2 * std::cos(link.angle), link.y + length / 2 * std::sin(link.angle), 0};
  }
  static void add_body(Scene& scene, const char* name, const Vector3& r, const Matrix3& A, const Vector3& v,
                       const Vector3& w) {
    Body& body = scene.bodies.emplace_back();
    body.name = name, body.mass = 1, body.inertia = 0.1 * Matrix3::Identity();
    body.position = r, body.orientation = A, body.velocity = v, body.angular_velocity = w;
  }
  static void add_hinge(Scene& scene, int i, int j, const Vector3& point, const Vector3& axis) {
    Joint& hinge = scene.joints.emplace_back();
    hinge.type = JointType::revolute, hinge.i = i, hinge.j = j, hinge.point = point, hinge.axis = axis;
  }
  static void add_motor(Scene& scene, int i, int j, const Vector3& axis, const std::string& angle) {
    Driver& motor = scene.drivers.emplace_back();
    motor.type = DriverType::angle, motor.i = i, motor.j = j, motor.axis = axis;
    motor.value = Expression::parse(angle);
  }

  double course_, turns_;
};

void expect_on_course(const CarriedLoop& loop, const Recorded& r) {
  for (const Snapshot& sample : r.samples) {
    const std::vector<CarriedLink> links = loop.links(sample.t);
    for (std::size_t k = 0; k < links.size(); ++k)
      EXPECT_LT((sample.bodies[k + 1].r - loop.place(links[k], sample.t)).norm(), 1e-6) << sample.t;
  }
}

class CarriedPassages : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, CarriedPassages, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// The rows that are set aside are chosen by poses in which they can be told from the others: a run that ends is right,
// and few stop. Chosen anew in that place they had been others than those that follow elsewhere: 9 of 12 runs of
// rattle, generalized-α and implicit Euler stopped or came apart.
TEST_P(CarriedPassages, StepsEndWhereRowsDependOnOneAnother) {
  int stops = 0, runs = 0;
  for (const double degrees : {45.0, 110.0}) {
    for (const double turns : {1.0, 2.0, 3.0}) {
      const CarriedLoop loop(degrees * std::numbers::pi / 180, turns);
      for (const IntegratorEntry& integrator : integrators()) {
        if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, GetParam())) continue;
        SCOPED_TRACE(::testing::Message() << integrator.name << ", " << degrees << " degrees, " << turns << " rad/s");
        Settings settings;
        settings.integrator = integrator.name, settings.formulation = GetParam();
        settings.step = 1.0 / 256, settings.rtol = 1e-8, settings.end = 1, settings.every = 1.0 / 16;
        const Recorded r = run(loop.scene(), settings);
        ++runs;
        if (!r.outcome.status.ok()) {
          ++stops;
          continue;
        }
        expect_on_course(loop, r);
      }
    }
  }
  EXPECT_LE(stops, 3) << "of " << runs;
}

// The rods are nearly in line for long: beside that place, too, rounding hides what leads through it, and a sample
// there is made by no step. Steps that go over it had been taken back without end.
TEST_P(CarriedPassages, OutputTimesInAPlaceThatIsHardlyLeftAreRefused) {
  for (const double degrees : {0.7, 1.0}) {
    const CarriedLoop loop(degrees * std::numbers::pi / 180, 0);
    for (const char* const integrator : {"auto", "dopri5", "dop853"}) {
      SCOPED_TRACE(::testing::Message() << integrator << ", " << degrees << " degrees");
      Settings settings;
      settings.integrator = integrator, settings.formulation = GetParam();
      settings.rtol = 1e-8, settings.end = 1, settings.every = 1.0 / 16;
      const Recorded there = run(loop.scene(), settings);
      if (!there.outcome.status.ok()) {
        EXPECT_EQ(there.outcome.status.failure, Failure::singular_position);
        EXPECT_NE(there.outcome.status.message.find("t = 0.5 s, an output time"), std::string::npos)
            << there.outcome.status.message;
      }
      settings.every = 0.06;
      const Recorded beside = run(loop.scene(), settings);
      EXPECT_TRUE(beside.outcome.status.ok()) << beside.outcome.status.message;
      expect_on_course(loop, there);
      expect_on_course(loop, beside);
    }
  }
}

}  // namespace
}  // namespace poinsot::test
