// What the tests of integrators of fixed step run: scenes whose motion shows an order, settings that leave nothing else
// to see, and the errors against a reference.
//
// The reference is dop853 at its tightest tolerance, whose own digits the tests of the benchmark problems hold.
#pragma once

#include <array>

#include "tests/support/forced_scene.h"
#include "tests/support/rows_scene.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

struct Method {
  std::string name;
  double order;
};
inline const std::vector<Method> kSecondOrder{{"generalized_alpha", 2}, {"generalized_alpha_i2", 2}, {"rattle", 2}};

// A case of the order tests; `turning` sets off, because from rest some errors cancel.
struct Case {
  std::string name;
  Scene scene;
  double end, step;  // step: the largest; the end is 8 n steps
};

inline Scene turning(std::string_view model, const Vector3& w) {
  Scene scene = scene_of(model);
  for (Body& body : scene.bodies) body.angular_velocity = w;  // velocities are projected onto the constraints
  return scene;
}

// The fast top turns so evenly in reps' angles that the errors of accelerations drown in the rounding that Φ/h²
// magnifies; its changes of chart have a test of their own.
inline std::vector<Case> cases(std::string_view formulation) {
  std::vector<Case> all{{"single_pendulum", scene_of("single_pendulum"), 0.8, 0.01},
                        {"free pendulum", turning("single_pendulum_free", {0, 0, 1}), 0.8, 0.01},
                        {"slider_crank", scene_of("slider_crank"), 0.4, 0.005},
                        {"four_link", scene_of("four_link"), 0.8, 0.005},
                        {"double_pendulum", turning("double_pendulum", {0, 0, 1}), 0.8, 0.01},
                        {"slow top", turning("heavy_top", {2.6, -4.2, 1.4}), 0.4, 0.005},
                        {"forced", forced(), 0.8, 0.01},
                        {"rows", rows_of_every_kind(), 0.4, 0.005}};
  if (formulation != "reps") all.push_back({"heavy_top", scene_of("heavy_top"), 0.04, 2.5e-4});
  return all;
}

inline Settings settings_of(std::string_view integrator, std::string_view formulation, double step, double end,
                            double every) {
  Settings s = dynamics(formulation, step, end, every);
  s.integrator = integrator;
  s.tolerance = 1e-9;  // rounding ends the iteration where this is less
  return s;
}

inline std::vector<Snapshot> reference(const Scene& scene, double step, double end, double every) {
  Settings s = settings_of("dop853", "rA", step, end, every);
  s.rtol = 1e-13;
  s.atol = 1e-14;
  return motion(scene, s);
}

// Largest errors of positions, velocities, accelerations and multipliers.
using Errors = std::array<double, 4>;

inline Errors absolute_errors(const Snapshot& x, const Snapshot& exact) {
  Errors e{};
  for (std::size_t b = 0; b < exact.bodies.size(); ++b) {
    const BodyState &u = x.bodies[b], &v = exact.bodies[b];
    e[0] = std::max({e[0], (u.r - v.r).cwiseAbs().maxCoeff(), (u.A - v.A).cwiseAbs().maxCoeff()});
    e[1] = std::max({e[1], (u.rd - v.rd).cwiseAbs().maxCoeff(), (u.w - v.w).cwiseAbs().maxCoeff()});
    e[2] = std::max({e[2], (u.rdd - v.rdd).cwiseAbs().maxCoeff(), (u.wd - v.wd).cwiseAbs().maxCoeff()});
  }
  for (std::size_t k = 0; k < exact.lambda.size(); ++k) e[3] = std::max(e[3], std::abs(x.lambda[k] - exact.lambda[k]));
  return e;
}

// Relative to the largest values.
inline Errors errors(const std::vector<Snapshot>& x, const std::vector<Snapshot>& exact) {
  const Distance d = distance(x, exact);
  double apart = 0, size = 0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    apart = std::max(apart, absolute_errors(x[n], exact[n])[3]);
    for (double lambda : exact[n].lambda) size = std::max(size, std::abs(lambda));
  }
  return {std::max(d.r, d.A), std::max(d.rd, d.w), std::max(d.rdd, d.wd), size > 0 ? apart / size : 0};
}

}  // namespace poinsot::test
