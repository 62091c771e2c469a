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

}  // namespace

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
         {},
         {},
         0};
  f.y = accuracy();
  f.columns = {"rod.y", "rod.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    return {swung_rod(std::numbers::pi / 2, 1 + at.nudge, t)};
  };
  return f;
}

Family pulse() {
  Family f;
  f.name = "pulse";
  f.title = "a force of short duration";
  f.about =
      "a mass of 1 kg on a slide, at rest until at 0.3 s a force of 1/x N sets in, for x s: from then on it moves with "
      "1 m/s. Truth: closed form";
  f.scenes = {R"json({"scene": 1, "name": "slide", "parameters": {"x": 0.1}, "gravity": [0, 0, 0],
    "bodies": [{"name": "mass", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0, 0, 0]}],
    "joints": [{"type": "translational", "bodies": ["ground", "mass"], "point": [0, 0, 0], "axis": [0.48, 0.6, 0.64]}],
    "forces": [{"type": "force", "body": "mass", "point": [0, 0, 0],
      "force": ["0.48/x*(step(t - 0.3) - step(t - 0.3 - x))", "0.6/x*(step(t - 0.3) - step(t - 0.3 - x))",
                "0.64/x*(step(t - 0.3) - step(t - 0.3 - x))"]}]})json"};
  f.x = {Axis::parameter,
         "duration of the force, s",
         "x",
         {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8},
         {1e-1, 1e-3, 1e-6},
         {},
         {},
         1e-1};
  f.y = accuracy();
  f.columns = {"mass.x", "mass.y", "mass.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    const double into = std::clamp(t - 0.3, 0.0, at.x);
    const double s = (1 + at.nudge) * (into * into / (2 * at.x) + std::max(0.0, t - 0.3 - at.x));
    return {{0.48 * s, 0.6 * s, 0.64 * s}};
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
  f.x = {Axis::length, "run, in 2 s", "", {5, 50, 500, 5000}, {5, 50}, {}, {}, 0};
  f.y = {Axis::accuracy, "step, s | rtol", "", {200, 2000}, {200}, {1e-6, 1e-10}, {1e-6}};
  f.end = 2;
  f.columns = {"rod.x", "rod.y", "rod.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    constexpr double kOwn = 9.81 * 0.5 / (0.25 + 0.02);
    const double angle = swing(std::sqrt(kOwn * (1 + at.nudge)), std::numbers::pi / 2, t).angle;
    return {{-0.4 * std::sin(angle), 0.3 * std::sin(angle), -0.5 * std::cos(angle)}};
  };
  return f;
}

}  // namespace poinsot::stability
