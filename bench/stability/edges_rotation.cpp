#include <Eigen/Geometry>
#include <cmath>

#include "bench/stability/edges.h"
#include "bench/stability/truths.h"

namespace poinsot::stability {
namespace {

// A(t) = Rx(α) Ry(x), α = −1 + 2 t: the third axis passes the z axis at the angle x.
Family euler_angles() {
  Family f;
  f.name = "euler_angles";
  f.title = "distance from the singularity of Euler angles";
  f.about =
      "a body on a spherical joint, its inertia about that the same in all directions, turns steadily; on the way its "
      "third axis comes as near to the z axis as x says, where ZXZ angles are singular. Truth: closed form";
  f.scenes = {R"json({"scene": 1, "name": "turning body", "gravity": [0, 0, 0], "parameters": {"x": 0.5},
    "bodies": [{"name": "body", "mass": 1, "inertia": [1, 1, 2],
      "position": ["sin(x)", "sin(1)*cos(x)", "cos(1)*cos(x)"],
      "orientation": {"matrix": [["cos(x)", 0, "sin(x)"], ["-sin(1)*sin(x)", "cos(1)", "sin(1)*cos(x)"],
                                 ["-cos(1)*sin(x)", "-sin(1)", "cos(1)*cos(x)"]]},
      "velocity": [0, "-2*cos(1)*cos(x)", "2*sin(1)*cos(x)"], "angular_velocity": ["2*cos(x)", 0, "2*sin(x)"]}],
    "joints": [{"type": "spherical", "bodies": ["ground", "body"], "point": [0, 0, 0]}]})json"};
  f.x = {Axis::parameter,
         "least angle between third axis and z, rad",
         "x",
         {0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.5},
         {0, 1e-12, 1e-6, 0.5},
         0.5};
  f.columns = {"body.x", "body.y", "body.z", "body.e0", "body.e1", "body.e2", "body.e3"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    const double a = -1 + 2 * (1 + at.nudge) * t, b = at.x, ca = std::cos(a / 2), sa = std::sin(a / 2),
                 cb = std::cos(b / 2), sb = std::sin(b / 2);
    return {{std::sin(b), -std::sin(a) * std::cos(b), std::cos(a) * std::cos(b), ca * cb, sa * cb, ca * sb, sa * sb}};
  };
  return f;
}

// Of a symmetric body about a fixed point, L is constant and the third axis turns about it with |L|/J₁.
Family spin() {
  Family f;
  f.name = "spin";
  f.title = "steps and tolerances against the spin of a body";
  f.about =
      "a symmetric body on a spherical joint without load, turning with w rad/s for 1 s, 0.6 of it across its axis: "
      "precession in closed form. Fixed steps turn by h w";
  f.scenes = {R"json({"scene": 1, "name": "spinning body", "gravity": [0, 0, 0], "parameters": {"w": 1},
    "bodies": [{"name": "body", "mass": 1, "inertia": [0.2, 0.2, 0.3], "position": [0, "-sin(1)", "cos(1)"],
      "orientation": {"axis": [1, 0, 0], "angle": 1},
      "velocity": [0, "-0.6*w*cos(1)", "-0.6*w*sin(1)"], "angular_velocity": ["0.6*w", 0, "0.8*w"]}],
    "joints": [{"type": "spherical", "bodies": ["ground", "body"], "point": [0, 0, 0]}]})json"};
  f.x = {Axis::parameter, "spin w, rad/s", "w", {1, 3, 10, 30, 100, 300, 1000}, {1, 10, 100}, 1};
  f.columns = {"body.x", "body.y", "body.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    const double J = 1.2, J3 = 0.3, w = at.x * (1 + at.nudge);
    const Eigen::Vector3d axis(0, -std::sin(1.0), std::cos(1.0)), across(1, 0, 0);
    const Eigen::Vector3d L = 0.6 * w * J * across + 0.8 * w * J3 * axis;
    const Eigen::Vector3d r = Eigen::AngleAxisd(L.norm() / J * t, L.normalized()) * axis;
    return {{r.x(), r.y(), r.z()}};
  };
  f.rate = [](const Place& at) { return at.x; };
  return f;
}

// Heavy symmetric top, J about its tip across and J₃ along its axis: w₃ and J φ̇ sin²θ + J₃ w₃ cosθ stay. A slow one is
// moved by its weight more than by its spin: both are nudged. Orientations change as it falls and spins, though its
// axis does not: Euler parameters turn by half the angle.
constexpr double kTopJ = 1.2, kTopJ3 = 0.3, kTopLoad = 9.81;
Family top() {
  Family f;
  f.name = "top";
  f.title = "steps and tolerances against the spin of a heavy top";
  f.about =
      "a symmetric top on a spherical joint, 1 rad from upright, let go with a spin of w rad/s about its axis: it "
      "nutates and precesses. Truth: one angle, Runge-Kutta";
  f.scenes = {R"json({"scene": 1, "name": "top", "gravity": [0, 0, -9.81], "parameters": {"w": 10},
    "bodies": [{"name": "top", "mass": 1, "inertia": [0.2, 0.2, 0.3], "position": [0, "-sin(1)", "cos(1)"],
      "orientation": {"axis": [1, 0, 0], "angle": 1}, "angular_velocity": [0, 0, "w"]}],
    "joints": [{"type": "spherical", "bodies": ["ground", "top"], "point": [0, 0, 0]}]})json"};
  f.x = {Axis::parameter, "spin w, rad/s", "w", {1, 10, 30, 100, 300, 1000}, {10, 100}, 10};
  f.columns = {"top.x", "top.y", "top.z"};
  f.truth = [](const Place& at, double t) -> std::vector<std::vector<double>> {
    constexpr double J = kTopJ;
    constexpr int kSteps = 10000;
    const double mgl = kTopLoad * (1 + at.nudge), spin = kTopJ3 * at.x * (1 + at.nudge), along = spin * std::cos(1.0);
    const Eigen::Vector3d y = runge_kutta<3>(Eigen::Vector3d(1, 0, 0), t, kSteps, [&](const Eigen::Vector3d& s) {
      const double sine = std::sin(s[0]), rate = (along - spin * std::cos(s[0])) / (J * sine * sine);  // φ̇
      return Eigen::Vector3d(s[1], sine * (J * rate * rate * std::cos(s[0]) - spin * rate + mgl) / J, rate);
    });
    const double sine = std::sin(y[0]);
    return {{sine * std::sin(y[2]), -sine * std::cos(y[2]), std::cos(y[0])}};
  };
  f.rate = [](const Place& at) { return std::hypot(std::sqrt(2 * kTopLoad * (1 + std::cos(1.0)) / kTopJ), at.x / 2); };
  return f;
}

}  // namespace

std::vector<Family> edges_of_rotation() {
  return {euler_angles(), spin(), top()};
}

}  // namespace poinsot::stability
