#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/stability/edges.h"
#include "bench/stability/truths.h"

namespace poinsot::stability {
namespace {

constexpr double kRate = 14.715;  // m g l/J of a rod of 1 m about its end, 1/s²

std::vector<double> swung_rod(double start, double g, double t) {
  const double angle = swing(std::sqrt(kRate * g), start, t).angle;
  return {std::sin(angle) / 2, -std::cos(angle) / 2};
}

Family inconsistent() {
  Family f;
  f.name = "inconsistent";
  f.title = "an initial state off its constraints";
  f.about =
      "a rod of bare constraints that stands x m off its hinge, and moves off at x m/s, along itself: projected, that "
      "is the rod on its hinge. Truth: elliptic functions";
  f.scenes = {R"json({"scene": 1, "name": "rod", "gravity": [0, 0, -9.81], "parameters": {"x": 0},
    "bodies": [{"name": "rod", "mass": 1, "inertia": ["1/12", 0.001, "1/12"], "position": [0, "0.5 + x", 0],
                "velocity": [0, "x", 0]}],
    "constraints": [
      {"type": "CD", "bodies": ["ground", "rod"], "c": [1, 0, 0], "s_i": [0, 0, 0], "s_j": [0, -0.5, 0]},
      {"type": "CD", "bodies": ["ground", "rod"], "c": [0, 1, 0], "s_i": [0, 0, 0], "s_j": [0, -0.5, 0]},
      {"type": "CD", "bodies": ["ground", "rod"], "c": [0, 0, 1], "s_i": [0, 0, 0], "s_j": [0, -0.5, 0]},
      {"type": "DP1", "bodies": ["ground", "rod"], "a_i": [1, 0, 0], "a_j": [0, 1, 0]},
      {"type": "DP1", "bodies": ["ground", "rod"], "a_i": [1, 0, 0], "a_j": [0, 0, 1]}]})json"};
  f.x = {Axis::parameter,
         "off by, m and m/s",
         "x",
         {0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 1e-1},
         {0, 1e-9, 1e-3, 1e-1},
         0};
  f.columns = {"rod.y", "rod.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    return {swung_rod(std::numbers::pi / 2, 1 + at.nudge, t)};
  };
  return f;
}

// A mass on a slide along a skew axis, pushed along it by 1 N times what is said.
std::string pushed(std::string_view times) {
  return fmt::format(R"json({{"scene": 1, "name": "slide", "parameters": {{"x": 0.1}}, "gravity": [0, 0, 0],
    "bodies": [{{"name": "mass", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0, 0, 0]}}],
    "joints": [{{"type": "translational", "bodies": ["ground", "mass"], "point": [0, 0, 0], "axis": [0.48, 0.6, 0.64]}}],
    "forces": [{{"type": "force", "body": "mass", "point": [0, 0, 0],
      "force": ["0.48{0}", "0.6{0}",
                "0.64{0}"]}}]}})json",
                     times);
}

Family pulse() {
  Family f;
  f.name = "pulse";
  f.title = "a force of short duration";
  f.about =
      "a mass of 1 kg on a slide, at rest until at 0.3 s a force of 1/x N sets in, for x s: from then on it moves with "
      "1 m/s. Truth: closed form";
  f.scenes = {pushed("/x*(step(t - 0.3) - step(t - 0.3 - x))")};
  f.x = {
      Axis::parameter, "duration of the force, s", "x", {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8}, {1e-1, 1e-3, 1e-6}, 1e-1};
  f.columns = {"mass.x", "mass.y", "mass.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    const double into = std::clamp(t - 0.3, 0.0, at.x);
    const double s = (1 + at.nudge) * (into * into / (2 * at.x) + std::max(0.0, t - 0.3 - at.x));
    return {{0.48 * s, 0.6 * s, 0.64 * s}};
  };
  f.warning = "has a kink or a jump";
  return f;
}

Family smooth_pulse() {
  Family f = pulse();
  f.name = "smooth_pulse";
  f.title = "a smooth force of short duration";
  f.about =
      "a mass of 1 kg on a slide, at rest until a force exp(-((t - 0.3)/x)^2)/(x sqrt(pi)) N passes: from then on it "
      "moves with 1 m/s. Truth: closed form";
  f.scenes = {pushed("*exp(-((t - 0.3)/x)^2)/(x*sqrt(pi))")};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    // The integral of (1 + erf u)/2 is (u (1 + erf u) + exp(-u^2)/sqrt(pi))/2.
    const auto twice = [&](double u) {
      return at.x / 2 * (u * (1 + std::erf(u)) + std::exp(-u * u) / std::sqrt(std::numbers::pi));
    };
    const double begin = -0.3 / at.x, before = (1 + std::erf(begin)) / 2;
    const double s = (1 + at.nudge) * (twice((t - 0.3) / at.x) - twice(begin) - before * t);
    return {{0.48 * s, 0.6 * s, 0.64 * s}};
  };
  f.warning = "varies within less than a step";
  return f;
}

// A force with a kink at 0.305 s, or none: its integrals from 0, piece by piece.
Family kinks() {
  constexpr auto scene = [](const char* force) {
    return fmt::format(R"json({{"scene": 1, "name": "slide", "gravity": [0, 0, 0],
    "tables": {{"bend": {{"points": [[0, 0], [0.305, 1], [1, 0]]}}}},
    "bodies": [{{"name": "mass", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0, 0, 0]}}],
    "joints": [{{"type": "translational", "bodies": ["ground", "mass"], "point": [0, 0, 0], "axis": [1, 0, 0]}}],
    "forces": [{{"type": "force", "body": "mass", "point": [0, 0, 0], "force": ["8*({0}) + 0*bend(t)", 0, 0]}}]}})json",
                       force);
  };
  Family f;
  f.name = "kinks";
  f.title = "kinks and jumps of a force";
  f.about =
      "a mass of 1 kg on a slide, at rest, under a force with a kink or a jump at 0.305 s, no time of a grid. Truth: "
      "closed form";
  f.scenes = {scene("t - 0.305"),     scene("abs(t - 0.305)"),  scene("max(0, t - 0.305)"),
              scene("min(t, 0.305)"), scene("sign(t - 0.305)"), scene("bend(t)")};
  f.x = {Axis::variant,
         "force (0: smooth, 1: abs, 2: max, 3: min, 4: sign, 5: table)",
         "",
         {0, 1, 2, 3, 4, 5},
         {0, 1, 2, 3, 4, 5},
         0};
  f.columns = {"mass.x"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    constexpr double k = 0.305;
    const double beyond = std::max(0.0, t - k), ramp = beyond * beyond * beyond / 6;  // of max(0, t − k)
    const double line = t * t * t / 6 - k * t * t / 2;
    double s = line;
    if (at.x == 1) s = 2 * ramp - line;
    if (at.x == 2) s = ramp;
    if (at.x == 3) s = t * t * t / 6 - ramp;
    if (at.x == 4) s = beyond * beyond - t * t / 2;
    if (at.x == 5) {  // natural spline of two pieces: M in the middle, each slope for itself
      const double d = 1 - k, M = 3 * (-1 / d - 1 / k), first = 1 / k - k * M / 6;
      const auto integral = [&](double u) { return first * u * u * u / 6 + M / (6 * k) * std::pow(u, 5) / 20; };
      const auto speed = [&](double u) { return first * u * u / 2 + M / (6 * k) * std::pow(u, 4) / 4; };
      const double u = std::min(t, k), b = -1 / d - d * M / 3, x = beyond;
      s = integral(u) + speed(u) * x + x * x / 2 + b * x * x * x / 6 + M * std::pow(x, 4) / 24 -
          M / (6 * d) * std::pow(x, 5) / 20;
    }
    return {{8 * (1 + at.nudge) * s}};
  };
  f.warning = "has a kink or a jump";
  return f;
}

Family drift() {
  Family f;
  f.name = "drift";
  f.title = "long runs";
  f.about =
      "a rod on a hinge about a skew axis swings from the horizontal for 2 s and up to 10 000 times as long, 200 fixed "
      "steps in every 2 s or more. Truth: elliptic functions";
  // The hinge along (0.6, 0.8, 0), the rod from (−0.8, 0.6, 0)/2.
  f.scenes = {R"json({"scene": 1, "name": "rod", "gravity": [0, 0, -9.81],
    "bodies": [{"name": "rod", "mass": 1, "inertia": [0.02, 0.02, 0.02], "position": [-0.4, 0.3, 0]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [0.6, 0.8, 0]}]})json"};
  f.x = {Axis::length, "run, in 2 s", "", {5, 50, 500, 5000}, {5, 50}, 0};
  f.y = accuracy({200, 2000}, {200}, {1e-6, 1e-10}, {1e-6});
  f.end = 2;
  f.columns = {"rod.x", "rod.y", "rod.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    constexpr double kOwn = 9.81 * 0.5 / (0.25 + 0.02);
    const double angle = swing(std::sqrt(kOwn * (1 + at.nudge)), std::numbers::pi / 2, t).angle;
    return {{-0.4 * std::sin(angle), 0.3 * std::sin(angle), -0.5 * std::cos(angle)}};
  };
  return f;
}

}  // namespace

std::vector<Family> edges_of_runs() {
  return {inconsistent(), pulse(), smooth_pulse(), kinks(), drift()};
}

}  // namespace poinsot::stability
