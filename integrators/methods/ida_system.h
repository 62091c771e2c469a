// IDA on the stabilized index-2 form of a problem: what it calls back for, and what a run asks of it.
//
// Residual, matrix and solution are stepping/stabilized_index2.h's. Its norm is sqrt(Σ (w y)²/n) over all unknowns,
// ours is over positions and velocities: their weights are the larger for it, the others' are none. Sizes are the
// largest so far: a tolerance that shrinks wherever a body pauses throws a multistep method back to small steps of
// order 1.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "integrators/integrator.h"
#include "integrators/methods/ida_objects.h"
#include "integrators/state.h"
#include "integrators/stepping/stabilized_index2.h"
#include "integrators/stepping/step_system.h"

namespace poinsot {

class IdaSystem {
 public:
  IdaSystem(const Run& run, PhaseClock& clock);

  // From a consistent state, the first time; later without what IDA remembers of the motion.
  Status begin(const State& at);
  void begin_again(const State& at);
  // The problem's rows are others. What IDA remembers of positions and velocities stays, and multipliers, which it
  // neither differentiates nor measures, are those of the new rows after its next iteration.
  Status renew();
  // Whether the tolerance itself is asked for already, and not a tenth of it; from now on it is.
  bool relax();

  // A step, or a part of it up to where it is to stop; whether IDA could, and the time it is at then.
  bool step(double& t);
  void stop_at(double t);
  void turn_at_most(double rate);  // counted angles, at rad/s, by no more than can be counted
  double last_step() const;
  double next_step() const;
  double time() const;
  // Position and velocity at a time within the last step; as IDA has them, off the constraints by its tolerance.
  void read(double t, State& at);
  void read_end(double t, State& at);  // of the last step, t as it gave it; with accelerations
  const Status& linear_status() const { return linear_status_; }  // of the last matrix or solution
  void count(Statistics& statistics) const;

 private:
  void copy(N_Vector y, double t, State& at) const;
  static IdaSystem& of(void* user) { return *static_cast<IdaSystem*>(user); }
  static std::span<double> values(N_Vector x) { return IdaObjects::values(x); }
  static int residual(double t, N_Vector y, N_Vector y_dot, N_Vector F, void* user);
  static int jacobian(double t, double alpha, N_Vector y, N_Vector y_dot, N_Vector, SUNMatrix, void* user, N_Vector,
                      N_Vector, N_Vector);
  static int solve(SUNLinearSolver shell, SUNMatrix, N_Vector x, N_Vector b, double);
  static int weights(N_Vector y, N_Vector w, void* user);

  Problem& problem_;
  const Settings& settings_;
  std::optional<StabilizedIndex2> form_;  // anew for other rows
  TimedSystem system_;
  std::vector<double> sizes_, sizes_now_;
  Status linear_status_;
  double share_;  // of the tolerance
  IdaObjects objects_;
};

}  // namespace poinsot
