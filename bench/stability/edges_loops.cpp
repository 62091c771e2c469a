#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "bench/stability/edges.h"
#include "bench/stability/truths.h"

namespace poinsot::stability {
namespace {

// Two posts and a coupler of 1 m, all as one pendulum: φ̈ = −m g cos φ/J from x with −3 rad/s.
double swung(double start, double rate, double t) {
  constexpr double m = 2, J = 1.7;
  constexpr int kSteps = 4000;
  const Eigen::Vector2d at = runge_kutta<2>(Eigen::Vector2d(start, rate), t, kSteps, [](const Eigen::Vector2d& y) {
    return Eigen::Vector2d(y[1], -m * 9.81 * std::cos(y[0]) / J);
  });
  return at[0];
}

constexpr double kSpin = -3;

std::vector<std::vector<double>> of_posts(const Place& at, double t) {
  const double phi = swung(at.x, kSpin * (1 + at.nudge), t);
  return {{0.5 * std::cos(phi), 0.5 * std::sin(phi), std::cos(phi) + 0.5, std::sin(phi)}};
}

// The posts at the angle x, and the joints at the coupler's ends.
std::string posts(std::string_view parameters, std::string_view joints) {
  return fmt::format(R"json({{"scene": 1, "name": "posts", "gravity": [0, -9.81, 0], "parameters": {{{}}},
    "bodies": [
      {{"name": "post", "mass": 1, "inertia": [0.02, 0.1, 0.1], "position": ["cos(x)/2", "sin(x)/2", 0],
       "velocity": ["1.5*sin(x)", "-1.5*cos(x)", 0], "angular_velocity": [0, 0, -3]}},
      {{"name": "post2", "mass": 1, "inertia": [0.02, 0.1, 0.1], "position": ["1 + cos(x)/2", "sin(x)/2", 0],
       "velocity": ["1.5*sin(x)", "-1.5*cos(x)", 0], "angular_velocity": [0, 0, -3]}},
      {{"name": "coupler", "mass": 1, "inertia": [0.02, 0.1, 0.1], "position": ["cos(x) + 0.5", "sin(x)", 0],
       "velocity": ["3*sin(x)", "-3*cos(x)", 0]}}],
    "joints": [
      {{"type": "revolute", "bodies": ["ground", "post"], "point": [0, 0, 0], "axis": [0, 0, 1]}},
      {{"type": "revolute", "bodies": ["ground", "post2"], "point": [1, 0, 0], "axis": [0, 0, 1]}},
      {}]}})json",
                     parameters, joints);
}

Family flat(std::string_view joints) {
  Family f;
  f.scenes = {posts(R"json("x": 1)json", joints)};
  f.x = {Axis::parameter,
         "angle before the flat position at the start, rad",
         "x",
         {0, 1e-15, 1e-13, 1e-10, 1e-7, 1e-4, 1e-2, 0.1, 1},
         {0, 1e-13, 1e-7, 0.1, 1},
         1};
  f.y = accuracy({20, 80, 320, 1280}, {20, 320});
  f.end = 0.2;
  f.columns = {"post.x", "post.y", "coupler.x", "coupler.y"};
  f.truth = of_posts;
  return f;
}

// The distance from f = 1 is that of the angle from 0: θ = x + 4 (t − ½)².
Family dp1_driver() {
  Family f;
  f.name = "dp1_driver";
  f.title = "a driven angle that comes near to 0, where a DP1 driver is singular";
  f.about =
      "a rotor whose angle is driven to x and back: by a DP1 constraint with f = cos of it, by the same with its "
      "alternate, and by an angle driver. Truth: the driver";
  f.scenes = {
      R"json({"scene": 1, "name": "rotor, DP1", "gravity": [0, -9.81, 0], "parameters": {"x": 0.5},
    "bodies": [{"name": "rotor", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": ["cos(x + 1)", "sin(x + 1)", 0],
      "orientation": {"axis": [0, 0, 1], "angle": "x + 1"}}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rotor"], "point": [0, 0, 0], "axis": [0, 0, 1]}],
    "constraints": [{"type": "DP1", "bodies": ["ground", "rotor"], "a_i": [1, 0, 0], "a_j": [1, 0, 0],
                     "f": "cos(x + 4*(t - 0.5)^2)"}]})json",
      R"json({"scene": 1, "name": "rotor, DP1 with alternate", "gravity": [0, -9.81, 0], "parameters": {"x": 0.5},
    "bodies": [{"name": "rotor", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": ["cos(x + 1)", "sin(x + 1)", 0],
      "orientation": {
  "axis" : [ 0, 0, 1 ], "angle" : "x + 1"
}
}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rotor"], "point": [0, 0, 0], "axis": [0, 0, 1]}],
    "constraints": [{"type": "DP1", "bodies": ["ground", "rotor"], "a_i": [1, 0, 0], "a_j": [1, 0, 0],
                     "f": "cos(x + 4*(t - 0.5)^2)",
                     "alternate": {"a_i": [0, 1, 0], "a_j": [1, 0, 0], "f": "sin(x + 4*(t - 0.5)^2)"}}]})json",
      R"json({"scene": 1, "name": "rotor, angle driver", "gravity": [0, -9.81, 0], "parameters": {"x": 0.5},
    "bodies": [{"name": "rotor", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": ["cos(x + 1)", "sin(x + 1)", 0],
      "orientation": {
  "axis" : [ 0, 0, 1 ], "angle" : "x + 1"
}
}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rotor"], "point": [0, 0, 0], "axis": [0, 0, 1]}],
    "drivers": [{"type": "angle", "bodies": ["ground", "rotor"], "axis": [0, 0, 1], "a_i": [1, 0, 0],
                 "a_j": [1, 0, 0], "angle": "x + 4*(t - 0.5)^2"}]})json"};
  f.x = {Axis::parameter,
         "least angle, rad",
         "x",
         {0, 1e-12, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 0.5},
         {0, 1e-8, 1e-3, 0.5},
         0.5};
  f.y = {Axis::variant, "driver (0: DP1, 1: DP1 with alternate, 2: angle)", "", {0, 1, 2}, {0, 1, 2}, 2};
  f.columns = {"rotor.x", "rotor.y"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    const double angle = at.x + 4 * (t - 0.5) * (t - 0.5);
    return {{std::cos(angle), std::sin(angle)}};
  };
  f.floor = [](const Place& at) {  // what rounding of the cosine leaves open of the angle
    const double epsilon = std::numeric_limits<double>::epsilon();
    return at.y < 2 ? epsilon / std::max(at.x, std::sqrt(epsilon)) : 0;
  };
  return f;
}

Family flat_redundant() {
  Family f = flat(R"json(
      {"type": "revolute", "bodies": ["post", "coupler"], "point": ["cos(x)", "sin(x)", 0], "axis": [0, 0, 1]},
      {"type": "revolute", "bodies": ["coupler", "post2"], "point": ["1 + cos(x)", "sin(x)", 0], "axis": [0, 0, 1]})json");
  f.name = "flat_redundant";
  f.title = "a flat four-bar, by revolutes alone";
  f.about =
      "two posts and a coupler of 1 m on four revolutes, three rows more than needed, pass the position in which all "
      "lie in a line and two branches meet. Truth: the branch that the velocities lead to, one pendulum";
  return f;
}

Family flat_planar() {
  Family f = flat(R"json(
      {"type": "cylindrical", "bodies": ["post", "coupler"], "point": ["cos(x)", "sin(x)", 0], "axis": [0, 0, 1]},
      {"type": "spherical", "bodies": ["coupler", "post2"], "point": ["1 + cos(x)", "sin(x)", 0]})json");
  f.name = "flat_planar";
  f.title = "a flat four-bar, without a row too many";
  f.about = "the same with a cylindrical and a spherical joint in the place of two revolutes";
  return f;
}

// In earnest such a loop is locked. What is within the accuracy of a drawing is meant to move.
Family misalignment() {
  Family f;
  f.name = "misalignment";
  f.title = "a redundant joint out of line";
  f.about =
      "a four-bar of revolutes whose last axis is tilted by x against the others: mobile where that is rounding, "
      "refused "
      "where the initial velocities contradict it. Truth: mobile or locked up to 1e-5 rad, above it locked, each to "
      "within x";
  f.scenes = {posts(R"json("x": 1, "tilt": 0)json", R"json(
      {"type": "revolute", "bodies": ["post", "coupler"], "point": ["cos(x)", "sin(x)", 0], "axis": [0, 0, 1]},
      {"type": "revolute", "bodies": ["coupler", "post2"], "s_i": [0.5, 0, 0], "s_j": ["cos(x)/2", "sin(x)/2", 0],
       "axis_i": [0, 0, 1], "axis_j": ["sin(tilt)", 0, "cos(tilt)"]})json")};
  f.x = {Axis::parameter,
         "tilt of one axis, rad",
         "tilt",
         {0, 1e-14, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2},
         {0, 1e-14, 1e-12, 1e-8, 1e-2},
         0};
  f.y = accuracy({20, 320}, {20}, {1e-4, 1e-8}, {1e-8});
  f.end = 0.2;
  f.columns = {"post.x", "post.y"};
  f.truth = [](const Place& at, double t) {
    constexpr double kMeant = 1e-5, kStart = 1, kRate = -3;
    const double phi = swung(kStart, kRate * (1 + at.nudge), t);
    std::vector<std::vector<double>> motions{{0.5 * std::cos(kStart), 0.5 * std::sin(kStart)}};
    if (at.x <= kMeant) motions.insert(motions.begin(), {0.5 * std::cos(phi), 0.5 * std::sin(phi)});
    return motions;
  };
  f.floor = [](const Place& at) { return at.x; };
  return f;
}

}  // namespace

std::vector<Family> edges_of_loops() {
  return {dp1_driver(), flat_redundant(), flat_planar(), misalignment()};
}

}  // namespace poinsot::stability
