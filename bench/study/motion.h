// A motion at common output times, whatever computed it, and how far two of them are apart.
//
// Differences are the largest over all output times and bodies (multipliers: constraint rows), relative to the size of
// what they are differences of, found in the motion that is compared with:
//   positions      |Δr| / L and the angle of AᵀA', rad         L = max |r|, 1 m where every r is 0 but for rounding
//   velocities     |Δṙ| / max |ṙ| and |Δω̄| / max |ω̄|
//   accelerations  |Δr̈| / max |r̈| and |Δω̄̇| / max |ω̄̇|
//   multipliers    |Δλ| in newtons / max |λ|: moments divided by L, the λ of D, which are forces per length, times L
// Where there is no motion of one kind (max |ṙ| below 1e-6 L max |ω̄|, or the other way round, which is rounding), the
// other kind measures both, by way of L. Where there is none of either (below 1e-10 of what follows), L over the time
// of the motion measures velocities, and the size of velocities over that time accelerations; forces then those that
// would give the masses such accelerations.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/simulate.h"
#include "integrators/start/reactions.h"

namespace poinsot::study {

inline constexpr std::array<std::string_view, 4> kQuantities{"position", "velocity", "acceleration", "multiplier"};
using PerQuantity = std::array<double, kQuantities.size()>;

struct Motion {
  std::vector<double> t;                       // s
  std::vector<std::vector<BodyState>> bodies;  // by time
  std::vector<std::vector<double>> lambda;     // by time, for every row of the model
};

// Adds samples of one run to a motion.
class MotionRecorder {
 public:
  explicit MotionRecorder(Motion& motion) : motion_(motion) {}
  void add(const Sample& sample);

 private:
  Motion& motion_;
  std::optional<Reactions> reactions_;
};

struct MotionRun {
  Outcome outcome;          // an InputError's message, too, stands in its status
  Motion motion;            // as far as it came
  double energy_drift = 0;  // largest |E − E(0)| at the output times, J
};

// Runs the scene and keeps what it gives out. Settings that do not fit the scene are a failure like any other, and so
// is an output time reached later than `longest` s after the start: an explicit method on a stiff scene.
MotionRun run_motion(const Scene& scene, const Settings& settings,
                     double longest = std::numeric_limits<double>::infinity());

// What differences from a motion are divided by.
struct Sizes {
  double length = 1;                                                                      // m
  double velocity = 1, angular_velocity = 1, acceleration = 1, angular_acceleration = 1;  // m/s, rad/s, m/s², rad/s²
  double force = 1;                                                                       // N
};
Sizes sizes(const Motion& motion, const Model& model);
Sizes body_sizes(const Motion& motion);  // all but the force; of an instant at 0 alone, 1 s is its time

// Of motions at the same times. Infinite where one ends early.
PerQuantity difference(const Motion& motion, const Motion& from, const Sizes& sizes, const Model& model);

// The same of the bodies, by kind: positions, angles, velocities, angular velocities and so on.
struct BodyDifference {
  double r = 0, A = 0, rd = 0, w = 0, rdd = 0, wd = 0;
};
BodyDifference body_difference(const Motion& motion, const Motion& from, const Sizes& sizes);

// Largest kinetic energy of the motion, J.
double kinetic_energy(const Motion& motion, const Model& model);

}  // namespace poinsot::study
