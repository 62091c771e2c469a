// Three parallel cranks whose feet are not in line move on at every angle, though any two of them come to a change
// point: rows that are kept come to depend on one another sooner than turns of bodies foretell, and others take their
// place before.
#include <gmock/gmock.h>

#include "tests/support/course.h"
#include "tests/support/every_way.h"
#include "tests/support/paradoxic_machines.h"

namespace poinsot::test {
namespace {

constexpr double kFrom = -0.5, kTo = 0.7;  // rad; change points at -0.142, 0 and 0.142

// Turning at w without any load.
Scene turning_cranks(Frames frames, double w) {
  Scene scene = parallel_cranks({frames, false, true});
  scene.gravity.setZero();
  const Vector3 spin(0, 0, w), crank(0.8 * std::cos(kFrom), 0.8 * std::sin(kFrom), 0);
  scene.bodies[0].velocity = spin.cross(crank);
  for (std::size_t k = 1; k < 4; ++k) {
    scene.bodies[k].velocity = spin.cross(0.5 * crank);
    scene.bodies[k].angular_velocity = scene.bodies[k].orientation.transpose() * spin;
  }
  return scene;
}

double turn_in_plane(const Scene& scene, const Snapshot& at, std::size_t body) {
  const Matrix3 A = at.bodies[body].A * scene.bodies[body].orientation.transpose();
  return std::atan2(A(1, 0), A(0, 0));
}

TEST(ParallelCranks, TurnEvenlyOverTheChangePointsOfEveryTwo) {
  for (const Frames frames : {Frames::drawn, Frames::quarter_turns, Frames::random}) {
    const Scene scene = turning_cranks(frames, 1);
    const int ways = in_every_way(2.5e-3, kTo - kFrom, [&](Settings settings) {
      SCOPED_TRACE(static_cast<int>(frames));
      settings.tolerance = 1e-7;
      settings.rtol = 1e-8;
      const Course course = move(scene, settings);
      ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
      EXPECT_GT(course.exchanges, 0);
      const IntegratorEntry& integrator = integrators().require(settings.integrator);
      const bool fixed = !integrator.controls_error;
      double off = 0;
      for (const Snapshot& sample : course.samples) {
        off = std::max(off, std::abs(turn_in_plane(scene, sample, 0)));
        for (const std::size_t crank : {1u, 2u, 3u})
          off = std::max(off, std::abs(turn_in_plane(scene, sample, crank) - sample.t));
      }
      EXPECT_LT(off, fixed && integrator.order == 1 ? 5e-3 : 1e-5);
      if (!fixed) return;  // whose steps are as long as the way between two change points
      EXPECT_EQ(course.outcome.statistics.divided_steps, 0);
      for (const std::string& notice : course.outcome.notices) {
        if (notice.find("singular position") == std::string::npos) continue;
        EXPECT_THAT(notice, ::testing::AnyOf(::testing::HasSubstr("singular position of the rows that are kept"),
                                             ::testing::HasSubstr("as beside a singular position")));
      }
    });
    EXPECT_GE(ways, 25);
  }
}

TEST(ParallelCranks, AreDrivenOverTheChangePointsOfEveryTwo) {
  for (const FormulationEntry& formulation : formulations()) {
    for (const Frames frames : {Frames::drawn, Frames::quarter_turns, Frames::random}) {
      for (const double step : {0.01, 0.02, 0.05}) {
        SCOPED_TRACE(fmt::format("{} frames {} step {}", formulation.name, static_cast<int>(frames), step));
        Scene scene = turning_cranks(frames, 1);
        Driver& motor = scene.drivers.emplace_back();
        motor.name = "motor", motor.i = scene.joints[0].i, motor.j = scene.joints[0].j;
        motor.axis = Vector3::UnitZ();
        motor.value = Expression::parse("t");
        const Course course = move(scene, kinematics(formulation.name, step, kTo - kFrom));
        ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
        for (const Snapshot& sample : course.samples)
          for (const std::size_t crank : {1u, 2u, 3u}) EXPECT_NEAR(turn_in_plane(scene, sample, crank), sample.t, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace poinsot::test
