// What implicit Euler takes out of a motion by itself.
//
// With M (v − v_n) = h (Q − Gᵀλ) at the end of a step its kinetic energy changes by what these forces do on the way
// h v, less ½ Δvᵀ M Δv with Δv = v − v_n. The end's forces on that way are more than the motion's by as much again
// where they are those of constraints or of springs: on a circle, and in the mean of a vibration. So a step takes about
//
//   Σ m |Δṙ|² + ΔL · Δω
//
// of energy from the motion, L being a body's angular momentum about its centre of mass and ω its rate, both in space:
// of a point that turns by φ in a step the part φ of its speed for each radian. It goes with the step's length;
// constant forces leave less. Forces and torques that are functions of time give a body h F(t), whatever the way: by
// these Δv makes no loss, and J · Δṙ + J' · Δω of their impulses J and J' is taken off. Mechanisms without degrees of
// freedom keep their motion whatever is lost. What rotation loses that no moment changes differs between the
// formulations (Rotations), and is not in it. Each mechanism of a scene (core/mechanisms.h) is looked at by itself: the
// motion of a large one says nothing of a small one's.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/body_state.h"
#include "core/scene.h"
#include "integrators/integrator.h"

namespace poinsot {

class NumericalDamping {
 public:
  explicit NumericalDamping(const Run& run);  // at its start; steps allocate nothing

  // After each step, which ended at x; the problem stands there.
  void look(const Problem& problem, const State& x) {
    if (!pushes_.empty()) push(problem, x);
    if (++since_ == kApart) add(problem, x);
  }
  // At the end of a run in steps of length h.
  void say(const Run& run, double h) const;

 private:
  static constexpr int kApart = 4;  // steps from one look to the next; each has its part in how v changed

  struct Motion {
    Vector3 rd, L, w;  // in space
  };
  struct Push {  // a force or torque that is a function of time, of a body
    int body;
    const PointForce* force;  // or a torque, on which
    const Torque* torque;
  };
  struct Impulse {
    Vector3 force = Vector3::Zero(), moment = Vector3::Zero();  // N s, N m s about the centre of mass, in space
  };
  struct Mechanism {
    int freedoms = 0;                                 // it moves freely, if only in part
    double kinetic = 0, taken = 0, most_kinetic = 0;  // J; at the last look, and since the start
    double noise = 0;                                 // J, of which rounding can make as much
  };
  static Motion motion(const Body& body, const BodyState& at);
  void list_pushes(const Model& model);
  void push(const Problem& problem, const State& x);
  void add(const Problem& problem, const State& x);

  const std::vector<int> mechanism_;  // of each body
  std::vector<Mechanism> mechanisms_;
  bool moves_ = false;        // one of them does
  int since_ = 0;             // steps since the last look
  std::vector<Motion> then_;  // at that look, of each body
  std::vector<Push> pushes_;
  std::vector<Impulse> impulses_;  // since then, of each body; empty where nothing pushes
  double pushed_until_ = 0;        // s
  std::vector<BodyState> bodies_;
  std::int64_t steps_ = 0;
  Eigen::VectorXd momentum_;
};

}  // namespace poinsot
