#include "integrators/methods/kinematics.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>

#include "integrators/jacobian_policy.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/observe.h"
#include "integrators/stepping/step_system.h"
#include "integrators/stepping/time_grid.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
namespace {

using Vector = Eigen::VectorXd;

class Kinematics final : public Integrator {
 public:
  Status run(Problem& problem, LinearSolver& solver, const Settings& settings, State& state, const Observer& observe,
             Statistics& statistics) override {
    const JacobianEntry& policy = jacobians().require(settings.jacobian);
    const bool predict = policy.refresh != Refresh::before_step;  // the original study's codes do not
    const TimeGrid grid(settings);
    PhaseClock clock;
    StepSystem system(problem, solver, MatrixKind::kinematic, statistics, clock);
    if (Status status = system.prepare(); !status.ok()) return status;
    std::unique_ptr<Consistent> inverse_dynamics;
    if (settings.reactions) inverse_dynamics = std::make_unique<Consistent>(problem, settings.linear_solver);

    Vector &q = state.q, &v = state.v, delta(problem.nc()), q_next(q.size()), dq(v.size());
    if (!settings.reactions) state.z.setZero(problem.nv());  // no multipliers

    Status status;
    clock.start();
    for (std::int64_t n = 0; n <= grid.steps && status.ok(); ++n) {
      const double t = grid.time(n);
      if (n > 0 && predict) {
        dq.noalias() = grid.step() * v;
        problem.retract(span(q), span(dq), span(q_next));
        q.swap(q_next);
      }
      status = position(problem, system, settings, policy.refresh, t, q, q_next, delta, statistics);
      if (!status.ok()) break;
      status = rates(problem, system, t, state, delta);
      if (!status.ok()) break;
      state.t = t;
      if (n > 0) ++statistics.steps;
      bool rewritten = false;
      if (status = accept(problem, state, rewritten); !status.ok()) break;
      if (grid.sampled(n)) {
        clock.lap(Phase::other);
        if (inverse_dynamics) {
          status = inverse_dynamics->accelerations(t, span(state.z));
          if (!status.ok()) break;
        }
        sample(observe, problem, state, statistics);
        clock.skip();
      }
    }
    finish(clock, statistics);
    return status;
  }

 private:
  static Status position(Problem& problem, StepSystem& system, const Settings& settings, Refresh refresh, double t,
                         Vector& q, Vector& q_next, Vector& delta, Statistics& statistics) {
    double correction = 0;
    for (int k = 0; k < settings.max_iterations; ++k) {
      problem.set_position(t, span(q));
      problem.position_residual(span(delta));
      // A kept matrix would carry the position past a bifurcation unseen: kinematics keeps none.
      if (refresh != Refresh::before_step || k == 0) {
        if (Status status = system.refresh(t, {}, {}, {}, {}); !status.ok()) return status;
      }
      delta = -delta;
      if (Status status = system.solve(t, span(delta)); !status.ok()) return status;
      problem.retract(span(q), span(delta), span(q_next));
      q.swap(q_next);
      ++statistics.newton_iterations;
      correction = delta.norm();
      if (!std::isfinite(correction)) {
        return {Failure::not_finite, t, fmt::format("at t = {:.9g} s the position's correction is not finite", t)};
      }
      if (correction < settings.tolerance) return {};
    }
    Eigen::Index largest = 0;
    delta.cwiseAbs().maxCoeff(&largest);
    return {
        Failure::not_converged, t,
        fmt::format("at t = {:.9g} s the position did not converge: after {} iterations the correction is {:.3g}, the "
                    "tolerance {:.3g}; {} moves most; the mechanism may be locked here or the driver ask for more "
                    "than it can reach; try a smaller step",
                    t, settings.max_iterations, correction, settings.tolerance,
                    problem.describe_unknown(static_cast<int>(largest)))};
  }

  static Status rates(Problem& problem, StepSystem& system, double t, State& x, Vector& rhs) {
    problem.set_position(t, span(x.q));
    if (Status status = system.refresh(t, {}, {}, {}, {}); !status.ok()) return status;
    problem.nu(span(rhs));
    if (Status status = system.solve(t, span(rhs)); !status.ok()) return status;
    x.v = rhs;
    problem.set_velocity(span(x.v));
    problem.gamma(span(rhs));
    if (Status status = system.solve(t, span(rhs)); !status.ok()) return status;
    x.z.head(problem.nv()) = rhs;
    return {};
  }
};

}  // namespace

std::unique_ptr<Integrator> make_kinematics() {
  return std::make_unique<Kinematics>();
}

}  // namespace poinsot
