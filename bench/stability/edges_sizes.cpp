#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "bench/stability/edges.h"
#include "bench/stability/truths.h"

namespace poinsot::stability {
namespace {

constexpr double kGravity = 9.81;
constexpr double kIndex3 = 1e-7;  // of rounding up to which accelerations of index 3 are given out (index1_output.cpp)

// Two rods of 1 m in a row, masses 1 and m, angles from the horizontal y axis: 0 and 1 rad at rest.
std::vector<double> double_pendulum(double m, double g, double t) {
  constexpr int kSteps = 4000;
  const Eigen::Vector4d start(0, 1, 0, 0);
  const Eigen::Vector4d at = runge_kutta<4>(start, t, kSteps, [&](const Eigen::Vector4d& y) {
    const double s = m / 2 * std::sin(y[0] - y[1]), c = m / 2 * std::cos(y[0] - y[1]);
    Eigen::Matrix2d M;
    M << 1.0 / 3 + m, c, c, m / 3;
    const Eigen::Vector2d load(-s * y[3] * y[3] - g * (0.5 + m) * std::cos(y[0]),
                               s * y[2] * y[2] - g * m / 2 * std::cos(y[1]));
    const Eigen::Vector2d a = M.inverse() * load;
    return Eigen::Vector4d(y[2], y[3], a[0], a[1]);
  });
  const Eigen::Vector2d u(std::cos(at[0]), std::sin(at[0])), v(std::cos(at[1]), std::sin(at[1]));
  return {u[0] / 2, u[1] / 2, u[0] + v[0] / 2, u[1] + v[1] / 2};
}

// A rod of 1 m about its end, from rest at `a` from below: y and z of its middle, their rates, the hinge's force.
struct Rod {
  double y, z, ay, az, fy, fz;
};
constexpr double kRodRate2 = kGravity * 0.5 / (0.25 + 1.0 / 12);  // m g l/J
Rod rod(double a, double g, double t) {
  const Swing s = swing(std::sqrt(kRodRate2 * g), a, t);
  const double c = std::cos(s.angle), n = std::sin(s.angle), r = 0.5;
  const double ay = r * (s.acceleration * c - s.rate * s.rate * n), az = r * (s.acceleration * n + s.rate * s.rate * c);
  return {r * n, -r * c, ay, az, ay, az + kGravity * g};
}

// What of the rod is looked at: two of its numbers, by the columns that hold them.
template <double Rod::*first, double Rod::*second>
Family rounding(std::string_view name, std::string_view title, std::vector<std::string_view> columns) {
  Family f;
  f.name = name;
  f.title = title;
  f.about =
      "a rod on a hinge, from rest at an angle from below, over 200 steps however short they are: what rounding "
      "leaves. "
      "Truth: elliptic functions";
  f.scenes = {R"json({"scene": 1, "name": "rod", "gravity": [0, 0, -9.81], "parameters": {"a": 1.5},
    "bodies": [{"name": "rod", "mass": 1, "inertia": ["1/12", 0.001, "1/12"], "position": [0, "sin(a)/2", "-cos(a)/2"],
                "orientation": {"axis": [1, 0, 0], "angle": "a - pi/2"}}],
    "joints": [{"type": "revolute", "name": "hinge", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}]})json"};
  f.x = {Axis::step,
         "step, s (error control: run / 200)",
         "",
         {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8},
         {1e-2, 1e-4, 1e-6, 1e-8},
         0};
  f.y = {Axis::parameter, "angle at the start, rad", "a", {0.5, 1.5, 3}, {1.5}, 1.5};
  f.steps = 200;
  f.columns = std::move(columns);
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    const Rod r = rod(at.y, 1 + at.nudge, t);
    return {{r.*first, r.*second}};
  };
  return f;
}

// Accelerations, and forces of as many newtons.
Family of_index1(Family f) {
  f.size = [](const Place&) { return kGravity; };
  f.floor = [](const Place&) { return kIndex3; };
  return f;
}

// Bodies in a row on parallel hinges along x, their frames turned by s about (1, 1, 1): the row turns as one.
std::string turning_chain(int bodies) {
  std::string list, joints;
  for (int k = 0; k < bodies; ++k) {
    list += fmt::format(R"json({0}{{"name": "link{1}", "mass": 1, "inertia": [0.1, 0.1, 0.1],
      "position": [0, {1}.5, 0], "velocity": [0, 0, {1}.5], "orientation": {{"axis": [1, 1, 1], "angle": "s"}},
      "angular_velocity": ["(1 + 2*cos(s))/3", "(1 - cos(s))/3 - sin(s)/sqrt(3)", "(1 - cos(s))/3 + sin(s)/sqrt(3)"]}})json",
                        k > 0 ? ",\n" : "", k);
    joints += fmt::format(R"json({0}{{"type": "revolute", "bodies": ["{1}", "link{2}"], "point": [0, {2}, 0],
      "axis": [1, 0, 0]}})json",
                          k > 0 ? ",\n" : "", k > 0 ? fmt::format("link{}", k - 1) : "ground", k);
  }
  return fmt::format(R"json({{"scene": 1, "name": "{} links", "gravity": [0, 0, 0], "parameters": {{"s": 0}},
    "bodies": [{}], "joints": [{}]}})json",
                     bodies, list, joints);
}

Family far_away() {
  Family f;
  f.name = "far_away";
  f.title = "size of a mechanism against its distance from the origin";
  f.about =
      "a rod on a hinge, s m long, d m from the origin in each direction, gravity as large as it is long: positions "
      "have sixteen digits from the origin. Truth: elliptic functions";
  f.scenes = {R"json({"scene": 1, "name": "rod", "gravity": [0, 0, "-9.81*s"], "parameters": {"s": 1, "d": 0},
    "bodies": [{"name": "rod", "mass": 1, "inertia": ["s^2/12", "0.001*s^2", "s^2/12"], "position": ["d", "d + s/2", "d"]}],
    "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": ["d", "d", "d"], "axis": [1, 0, 0]}]})json"};
  f.x = {Axis::parameter, "distance, m", "d", {0, 1, 1e2, 1e4, 1e6, 1e8, 1e10}, {0, 1e4, 1e8}, 0};
  f.y = {Axis::parameter, "size, m", "s", {1e-6, 1e-3, 1, 1e3, 1e6}, {1e-3, 1, 1e3}, 1};
  f.columns = {"rod.y", "rod.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    const Rod r = rod(std::numbers::pi / 2, 1 + at.nudge, t);
    return {{at.x + at.y * r.y, at.x + at.y * r.z}};
  };
  f.size = [](const Place& at) { return at.y; };
  f.reach = [](const Place& at) { return at.x * std::numbers::sqrt3 / at.y; };
  return f;
}

Family mass_ratio() {
  Family f;
  f.name = "mass_ratio";
  f.title = "mass ratio of two rods";
  f.about = "a double pendulum whose outer rod is m times as heavy. Truth: two angles, Runge-Kutta";
  f.scenes = {R"json({"scene": 1, "name": "two rods", "gravity": [0, 0, -9.81], "parameters": {"m": 1},
    "bodies": [
      {"name": "inner", "mass": 1, "inertia": ["1/12", 0.001, "1/12"], "position": [0, 0.5, 0]},
      {"name": "outer", "mass": "m", "inertia": ["m/12", "0.001*m", "m/12"],
       "position": [0, "1 + cos(1)/2", "sin(1)/2"], "orientation": {"axis": [1, 0, 0], "angle": 1}}],
    "joints": [
      {"type": "revolute", "bodies": ["ground", "inner"], "point": [0, 0, 0], "axis": [1, 0, 0]},
      {"type": "revolute", "bodies": ["inner", "outer"], "point": [0, 1, 0], "axis": [1, 0, 0]}]})json"};
  f.x = {Axis::parameter,
         "mass of the outer rod over that of the inner one",
         "m",
         {1e-8, 1e-6, 1e-4, 1e-2, 1, 1e2, 1e4, 1e6, 1e8},
         {1e-8, 1e-4, 1, 1e4, 1e8},
         1};
  f.columns = {"inner.y", "inner.z", "outer.y", "outer.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    return {double_pendulum(at.x, kGravity * (1 + at.nudge), t)};
  };
  return f;
}

Family skew_chain() {
  static constexpr int kBodies[] = {3, 10, 50};
  Family f;
  f.name = "skew_chain";
  f.title = "length of a chain against the skewness of its frames";
  f.about =
      "a straight chain of 3, 10 and 50 links without gravity turns about its hinge at 1 rad/s; the links' frames are "
      "turned from the hinges' axis by an angle: how badly conditioned a chain is shows in skew frames. Truth: a "
      "circle";
  for (const int bodies : kBodies) f.scenes.push_back(turning_chain(bodies));
  f.x = {Axis::variant, "links (0: 3, 1: 10, 2: 50)", "", {0, 1, 2}, {0, 1, 2}, 0};
  f.y = {Axis::parameter, "frames turned by, rad", "s", {0, 1e-12, 1e-9, 1e-6, 1e-3, 1}, {0, 1}, 0};
  f.end = 0.5;
  f.steps = 20;
  f.columns = {"link2.y", "link2.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    return {{2.5 * std::cos((1 + at.nudge) * t), 2.5 * std::sin((1 + at.nudge) * t)}};
  };
  f.size = [](const Place&) { return 2.5; };
  f.reach = [](const Place& at) { return kBodies[static_cast<int>(at.x)] / 2.5; };
  return f;
}

// On the slow solution ξ = 0.1 k/(k − 1) cos t of ξ̈ = −k ξ + 0.1 k cos t.
Family stiffness() {
  Family f;
  f.name = "stiffness";
  f.title = "stiffness of a spring against the step";
  f.about =
      "a mass of 1 kg on a slide along a skew axis, a spring of k N/m, a slow load of 0.1 k cos t: started on the slow "
      "motion, nothing rings. Truth: closed form";
  f.scenes = {R"json({"scene": 1, "name": "slide", "parameters": {"k": 100}, "gravity": [0, 0, 0],
    "bodies": [{"name": "mass", "mass": 1, "inertia": [0.1, 0.2, 0.3],
                "position": ["0.48*(1 + 0.1*k/(k - 1))", "0.6*(1 + 0.1*k/(k - 1))", "0.64*(1 + 0.1*k/(k - 1))"]}],
    "joints": [{"type": "translational", "bodies": ["ground", "mass"], "point": [0, 0, 0], "axis": [0.48, 0.6, 0.64]}],
    "forces": [
      {"type": "spring", "bodies": ["ground", "mass"], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "stiffness": "k", "length": 1},
      {"type": "force", "body": "mass", "point": [0, 0, 0],
       "force": ["0.048*k*cos(t)", "0.06*k*cos(t)", "0.064*k*cos(t)"]}]})json"};
  f.x = {Axis::parameter, "stiffness, N/m", "k", {1e2, 1e3, 1e4, 1e5, 1e6, 1e8, 1e10}, {1e2, 1e4, 1e6, 1e8}, 1e2};
  f.columns = {"mass.x", "mass.y", "mass.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    const double slow = 0.1 * at.x / (at.x - 1) * (1 + at.nudge) * std::cos(t), s = 1 + slow;
    return {{0.48 * s, 0.6 * s, 0.64 * s}};
  };
  f.size = [](const Place&) { return 0.1; };
  f.reach = [](const Place&) { return 11.; };
  return f;
}

}  // namespace

std::vector<Family> edges_of_sizes() {
  return {far_away(),
          mass_ratio(),
          skew_chain(),
          stiffness(),
          rounding<&Rod::y, &Rod::z>("rounding_positions", "rounding at short steps: positions", {"rod.y", "rod.z"}),
          of_index1(rounding<&Rod::ay, &Rod::az>("rounding_accelerations", "rounding at short steps: accelerations",
                                                 {"rod.ay", "rod.az"})),
          of_index1(rounding<&Rod::fy, &Rod::fz>("rounding_reactions", "rounding at short steps: reactions",
                                                 {"hinge.fy", "hinge.fz"}))};
}

}  // namespace poinsot::stability
