// How to solve: the solver configuration, one field per key of the configuration file and of the command line.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "linsolve/linear_system.h"

namespace poinsot {

enum class Analysis { kinematics, dynamics };
enum class Assembly { small, always, never };  // project an initial state that violates the constraints

// Below this relative tolerance error control would chase rounding (Hairer's codes set the same bound).
inline constexpr double kLeastRtol = 10 * std::numeric_limits<double>::epsilon();

// Below this end time, s, steps and their sixteenth digits would be too small to be told apart.
inline constexpr double kLeastEnd = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();

// `jacobian` is "exact" although others are cheaper: with implicit Euler over all models and formulations "kept" takes
// 0.65 (tolerance 1e-3) and 0.74 (1e-8) of its instructions, "simplified" 0.73 and 0.75 (commit 4309907). But
// "simplified" stops on the double four-bar and on Andrews' mechanism before a second is over, where at 1e-3 "exact"
// and "kept" do not; and "kept" spoils the order of implicit Euler at the default tolerance (free body, reps).
struct Settings {
  Analysis analysis = Analysis::dynamics;
  std::string formulation = "rA";
  std::string integrator = "auto";  // of dynamics
  std::string linear_solver = "auto", linear_system = "auto";
  std::string jacobian = "exact";
  std::string stopping = "relative";  // of Newton's method in dynamics
  double step = 1e-3;                 // s
  double end = 1;                     // s; the last step lands on it exactly
  double tolerance = 1e-3;     // Newton: as `stopping` measures; in kinematics 2-norm of the correction of the position
  double rtol = 1e-8;          // integrators with error control
  std::optional<double> atol;  // rtol/100 where it is not given
  int max_iterations = 20;
  bool retry = true;  // fixed steps: one that fails is done in halves of it, and halves of those
  double every = 0;   // s between outputs; 0: every step
  Assembly assembly = Assembly::small;
  bool reactions = false;  // kinematics: find the multipliers, too (inverse dynamics)
  bool signals = false;    // follow the angles of joints with their turns (integrators/signals.h), and reactions
  std::map<std::string, double, std::less<>> parameters = {};  // that are given of those the integrator declares

  LinearChoice linear() const { return {linear_solver, linear_system}; }
  double absolute_tolerance() const { return atol.value_or(rtol / 100); }
};

}  // namespace poinsot
