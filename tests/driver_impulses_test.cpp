// Where the rate of a driver jumps the energy that its impulse brings is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

// A wheel of 3 kg m2 that a motor begins to turn at 0.5 s, with a weight on a rod 0.4 m away.
Scene motor(const char* angle) {
  Scene scene;
  Body& wheel = scene.bodies.emplace_back();
  wheel.name = "wheel", wheel.mass = 1, wheel.inertia = Vector3(1, 2, 3).asDiagonal();
  Body& weight = scene.bodies.emplace_back();
  weight.name = "weight", weight.mass = 5, weight.inertia = Vector3(0.1, 0.1, 0.2).asDiagonal();
  weight.position = {0.4, 0, 0};
  Joint& hinge = scene.joints.emplace_back();
  hinge.name = "hinge", hinge.type = JointType::revolute, hinge.j = 0, hinge.axis = {0, 0, 1};
  Joint& weld = scene.joints.emplace_back();
  weld.name = "weld", weld.type = JointType::fixed, weld.i = 0, weld.j = 1, weld.point = {0.4, 0, 0};
  Driver& drive = scene.drivers.emplace_back();
  drive.name = "motor", drive.type = DriverType::angle, drive.j = 0, drive.axis = {0, 0, 1};
  drive.value = Expression::parse(angle);
  return scene;
}

TEST(DriverImpulses, are_told_with_the_energy_they_bring) {
  constexpr double kInertia = 3 + 0.2 + 5 * 0.16;
  for (const char* method : {"auto", "dopri5", "dop853", "radau5", "ida"})
    for (const std::string& formulation : formulation_names()) {
      if (method == std::string_view("ida") && formulation != "rp") continue;
      SCOPED_TRACE(fmt::format("{} {}", method, formulation));
      Settings settings;
      settings.integrator = method, settings.formulation = formulation, settings.end = settings.every = 1;
      for (const auto& [angle, gain, word] :
           {std::tuple("2*max(0, t - 0.5)", 2.0, "brings"), std::tuple("t - max(0, t - 0.5)", 0.5, "takes")}) {
        const Outcome outcome = simulate(motor(angle), settings, [](const Sample&) {});
        ASSERT_TRUE(outcome.status.ok()) << outcome.status.message;
        ASSERT_FALSE(outcome.notices.empty());
        std::smatch found;
        const std::regex pattern(
            "at t = 0.5 s the rate of driver 'motor' .* jumps by .*, and the ([0-9.]+) J that it " + std::string(word));
        ASSERT_TRUE(std::regex_search(outcome.notices.back(), found, pattern)) << outcome.notices.back();
        EXPECT_NEAR(std::stod(found[1]), gain * gain * kInertia / 2 * (gain == 0.5 ? 4 : 1), 0.01 * kInertia);
      }
      const Outcome smooth = simulate(motor("max(0, t - 0.5)^2"), settings, [](const Sample&) {});
      EXPECT_THAT(smooth.notices, Each(Not(HasSubstr("impulse"))));
    }
}

}  // namespace
}  // namespace poinsot::test
