// What implicit Euler takes out of a motion by itself.
//
// With M (v − v_n) = h (Q − Gᵀλ) at the end of a step its kinetic energy changes by what these forces do on the way
// h v, less ½ Δvᵀ M Δv with Δv = v − v_n. The end's forces on that way are more than the motion's by as much again
// where they are those of constraints or of springs: on a circle, and in the mean of a vibration. So a step takes about
//
//   Σ m |Δṙ|²
//
// of energy from the motion of the centres of mass: of a point that turns by φ in a step the part φ of its speed for
// each radian. It goes with the step's length; constant forces leave less. Mechanisms without degrees of freedom keep
// their motion whatever is lost. What rotation loses differs between the formulations (Rotations).
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "integrators/integrator.h"

namespace poinsot {

class NumericalDamping {
 public:
  explicit NumericalDamping(const Run& run);  // at its start; steps allocate nothing

  // After each step, which ended with v; the problem stands there.
  void look(const Problem& problem, const Eigen::VectorXd& v) {
    if (++since_ == kApart) add(problem, v);
  }
  // At the end of a run in steps of length h.
  void say(const Run& run, double h) const;

 private:
  static constexpr int kApart = 4;  // steps from one look to the next; each has its part in how v changed

  void add(const Problem& problem, const Eigen::VectorXd& v);

  const bool moves_;      // freely, if only in part
  int since_ = 0;         // steps since the last look
  Eigen::VectorXd then_;  // v of that look, whose ṙ are the same in all coordinates
  std::int64_t steps_ = 0;
  double taken_ = 0, most_kinetic_ = 0;  // J
  Eigen::VectorXd momentum_;
};

}  // namespace poinsot
