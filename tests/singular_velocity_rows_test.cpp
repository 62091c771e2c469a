// Rows of velocities alone (pfaffian) that come to depend on one another: a snakeboard whose trucks turn through +90°
// and −90°, so that both pairs of wheels allow it to roll across, and hold it twice along. The motion goes through.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/scene_reader.h"
#include "integrators/integrator.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

constexpr double kHalfLength = 0.5, kEnd = 2.5, kOutputs = 0.05;

Scene snakeboard(double rate) {
  return parse_scene(fmt::format(R"j({{"scene": 1, "name": "snakeboard", "gravity": [0, 0, -9.81], "bodies": [
        {{"name": "board", "mass": 3, "inertia": [0.05, 0.3, 0.3], "position": [0, 0, 0], "velocity": [0.5, 0, 0]}},
        {{"name": "front", "mass": 0.5, "inertia": [0.01, 0.01, 0.02], "position": [0.5, 0, 0],
          "velocity": [0.5, 0, 0], "angular_velocity": [0, 0, {0:.17g}]}},
        {{"name": "rear", "mass": 0.5, "inertia": [0.01, 0.01, 0.02], "position": [-0.5, 0, 0],
          "velocity": [0.5, 0, 0], "angular_velocity": [0, 0, -{0:.17g}]}},
        {{"name": "rotor", "mass": 1, "inertia": [0.1, 0.1, 0.2], "position": [0, 0, 0.1], "velocity": [0.5, 0, 0]}}],
      "constraints": [
        {{"type": "CD", "bodies": ["ground", "board"], "c": [0, 0, 1], "s_i": [0, 0, 0], "s_j": [0, 0, 0]}},
        {{"type": "DP1", "bodies": ["ground", "board"], "a_i": [0, 0, 1], "a_j": [1, 0, 0]}},
        {{"type": "DP1", "bodies": ["ground", "board"], "a_i": [0, 0, 1], "a_j": [0, 1, 0]}},
        {{"type": "pfaffian", "bodies": ["ground", "front"], "a_j": [0, 1, 0], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "f": 0}},
        {{"type": "pfaffian", "bodies": ["ground", "rear"], "a_j": [0, 1, 0], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "f": 0}}],
      "joints": [
        {{"type": "revolute", "bodies": ["board", "front"], "point": [0.5, 0, 0], "axis": [0, 0, 1]}},
        {{"type": "revolute", "bodies": ["board", "rear"], "point": [-0.5, 0, 0], "axis": [0, 0, 1]}},
        {{"type": "revolute", "bodies": ["board", "rotor"], "point": [0, 0, 0], "axis": [0, 0, 1]}}],
      "drivers": [
        {{"type": "angle", "bodies": ["board", "front"], "axis": [0, 0, 1], "angle": "{0:.17g}*t"}},
        {{"type": "angle", "bodies": ["board", "rear"], "axis": [0, 0, 1], "angle": "-{0:.17g}*t"}},
        {{"type": "angle", "bodies": ["board", "rotor"], "axis": [0, 0, 1], "angle": "0.7*(1-cos(2*t))"}}]}})j",
                                 rate),
                     "snakeboard");
}

// The board's x, y, θ and the speed s of the only way it can go: v = s cos φ along it, θ̇ = s sin φ / l; with m all its
// mass and I its inertia about its centre, virtual power along that way is
//
//   (m cos²φ + I sin²φ/l²) ṡ + (I/l² − m) s φ̇ sin φ cos φ + I_rotor ψ̈ sin φ/l = 0.
using Reduced = std::array<double, 4>;

Reduced reduced_rates(double rate, double t, const Reduced& y) {
  constexpr double l = kHalfLength, mass = 5, inertia = 0.3 + 2 * (0.02 + 0.5 * l * l) + 0.2, rotor = 0.2;
  const double c = std::cos(rate * t), s = std::sin(rate * t), speed = y[3], psi_dd = 2.8 * std::cos(2 * t);
  const double load = (inertia / (l * l) - mass) * speed * rate * s * c + rotor * psi_dd * s / l;
  return {speed * c * std::cos(y[2]), speed * c * std::sin(y[2]), speed * s / l,
          -load / (mass * c * c + inertia * s * s / (l * l))};
}

// Runge and Kutta's method of order 4, in steps short enough for its error to be rounding.
Reduced reduced(double rate, double end) {
  constexpr int kSteps = 4000;
  const double h = end / kSteps;
  Reduced y{0, 0, 0, 0.5};
  const auto at = [&](const Reduced& k, double by) {
    Reduced to = y;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += by * k[i];
    return to;
  };
  for (int n = 0; n < kSteps; ++n) {
    const double t = n * h;
    const Reduced a = reduced_rates(rate, t, y), b = reduced_rates(rate, t + h / 2, at(a, h / 2)),
                  c = reduced_rates(rate, t + h / 2, at(b, h / 2)), d = reduced_rates(rate, t + h, at(c, h));
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return y;
}

double off(double rate, const std::vector<Snapshot>& samples) {
  double most = 0;
  for (const Snapshot& sample : samples) {
    if (sample.t == 0) continue;
    const Reduced y = reduced(rate, sample.t);
    most = std::max(most, std::hypot(sample.bodies[0].r.x() - y[0], sample.bodies[0].r.y() - y[1]));
  }
  return most;
}

// A time to which samples come within 1e-3 to 1e-5 s of the position, and rates that end fixed steps anywhere beside it
// and within 3.6e-6 rad.
constexpr std::array kRates{1.3685081090021642, 0.95, 1.2};

class SingularVelocityRows : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, SingularVelocityRows, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

TEST_P(SingularVelocityRows, ArePassedUnderErrorControl) {
  for (const double rate : kRates)
    for (const IntegratorEntry& integrator : integrators()) {
      if (!integrator.controls_error || refusal_of(integrator, GetParam())) continue;
      for (const double rtol : {1e-8, 1e-10}) {
        SCOPED_TRACE(::testing::Message() << integrator.name << ' ' << rtol << ", rate " << rate);
        const std::vector<Snapshot> samples =
            motion(snakeboard(rate), controlled(integrator.name, GetParam(), rtol, kEnd, kOutputs));
        EXPECT_LT(off(rate, samples), 10 * rtol);
      }
    }
}

// Samples close to one another and to the position.
TEST_P(SingularVelocityRows, LeaveSamplesBesideOnTheMotion) {
  const double rate = kRates[0], passed = std::numbers::pi / 2 / rate;
  for (const double beside : {-1e-3, -1e-5, 1e-7, 1e-4, 2e-3}) {
    SCOPED_TRACE(::testing::Message() << beside);
    const double every = passed + beside;
    const std::vector<Snapshot> samples =
        motion(snakeboard(rate), controlled("dop853", GetParam(), 1e-9, 2 * every, every));
    EXPECT_LT(off(rate, samples), 1e-8);
  }
}

// To the order of the method, whose error without them is about a tenth of these bounds.
TEST_P(SingularVelocityRows, ArePassedInFixedSteps) {
  constexpr double kStep = 1e-3;
  for (const double rate : kRates)
    for (const auto& [integrator, most] : {std::pair{"implicit_euler", 5e-3}, std::pair{"half_implicit", 1e-2},
                                           std::pair{"rattle", 2e-6}, std::pair{"generalized_alpha", 2e-6}}) {
      SCOPED_TRACE(::testing::Message() << integrator << ", rate " << rate);
      Settings settings = dynamics(GetParam(), kStep, kEnd, kOutputs);
      settings.integrator = integrator;
      EXPECT_LT(off(rate, motion(snakeboard(rate), settings)), most);
    }
}

}  // namespace
}  // namespace poinsot::test
