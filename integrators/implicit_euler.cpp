#include "integrators/implicit_euler.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/jacobian_policy.h"
#include "integrators/observe.h"
#include "integrators/step_system.h"
#include "integrators/time_grid.h"

namespace poinsot {
namespace {

using Vector = Eigen::VectorXd;
std::span<double> span(Vector& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

class ImplicitEuler final : public Integrator {
 public:
  Status run(Problem& problem, LinearSolver& solver, const Settings& settings, State& state, const Observer& observe,
             Statistics& statistics) override {
    const JacobianEntry& policy = *find_jacobian(settings.jacobian);
    const TimeGrid grid(settings);
    const double h = grid.step();
    const StepScale scale{1, h, h * h};
    PhaseClock clock;
    StepSystem system(problem, solver, policy.matrix, statistics, clock);
    if (Status status = system.prepare(); !status.ok()) return status;

    const Eigen::Index nv = problem.nv(), nc = problem.nc();
    Vector q = Eigen::Map<Vector>(state.q.data(), problem.nq()), v = Eigen::Map<Vector>(state.v.data(), nv);
    Vector z(nv + nc);  // (a, λ)
    z << Eigen::Map<Vector>(state.a.data(), nv), Eigen::Map<Vector>(state.lambda.data(), nc);
    const std::span<double> a(z.data(), static_cast<std::size_t>(nv)),
        lambda(z.data() + nv, static_cast<std::size_t>(nc));
    Vector q_n = q, v_n = v, dq(nv), delta(nv + nc);
    const std::span<double> delta_v(delta.data(), static_cast<std::size_t>(nv));

    problem.set_position(0, span(q));
    problem.set_velocity(span(v));
    sample(observe, problem, 0, span(q), span(v), a, lambda, statistics);

    clock.start();
    for (std::int64_t n = 1; n <= grid.steps; ++n) {
      const double t = grid.time(n);
      q_n.swap(q);
      v_n.swap(v);
      const auto advance = [&] {  // v and q that belong to the acceleration in z
        v.noalias() = v_n + h * z.head(nv);
        dq.noalias() = h * v;
        problem.retract(span(q_n), span(dq), span(q));
      };
      bool converged = false;
      double correction = 0, before = INFINITY;
      for (int k = 0; k < settings.max_iterations && !converged; ++k) {
        advance();
        problem.set_position(t, span(q));
        problem.set_velocity(span(v));
        problem.step_residual(scale, a, lambda, span(delta));
        if (k == 0 || policy.refresh == Refresh::every_iteration) {
          if (Status status = system.refresh(t, scale, span(dq), a, lambda); !status.ok()) {
            return give_up(status, q_n, v_n, state, clock, statistics);
          }
        }
        delta = -delta;
        if (Status status = system.solve(t, span(delta)); !status.ok()) {
          return give_up(status, q_n, v_n, state, clock, statistics);
        }
        problem.lower(span(dq), delta_v);
        z += delta;
        correction = delta.norm();
        ++statistics.newton_iterations;
        converged = correction < settings.tolerance ||
                    (correction > 0.5 * before && is_rounding(delta.head(nv), scale.position, q));
        before = correction;
        if (!std::isfinite(correction)) break;
      }
      if (!converged) {
        return give_up(not_converged(problem, t, delta, correction, settings), q_n, v_n, state, clock, statistics);
      }
      advance();
      ++statistics.steps;
      if (problem.has_discrete_state() || grid.sampled(n)) {
        problem.set_position(t, span(q));
        problem.set_velocity(span(v));
        if (problem.has_discrete_state() && problem.accept(t, span(q), span(v), a)) {
          problem.set_position(t, span(q));
          problem.set_velocity(span(v));
        }
      }
      if (grid.sampled(n)) {
        clock.lap(Phase::other);
        sample(observe, problem, t, span(q), span(v), a, lambda, statistics);
        clock.skip();
      }
    }
    finish(clock, statistics);
    state.q.assign(q.begin(), q.end());
    state.v.assign(v.begin(), v.end());
    state.a.assign(a.begin(), a.end());
    state.lambda.assign(lambda.begin(), lambda.end());
    return {};
  }

 private:
  // A correction that has stopped to shrink and moves positions by no more than their rounding: Newton's method cannot
  // do better in this arithmetic, whatever the tolerance asks (with small steps Φ/h² magnifies the rounding of Φ).
  static bool is_rounding(const Eigen::Ref<const Vector>& delta, double h2, const Vector& q) {
    constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();
    return h2 * delta.cwiseAbs().maxCoeff() <= kRounding * std::max(1.0, q.cwiseAbs().maxCoeff());
  }

  static Status not_converged(const Problem& problem, double t, const Vector& delta, double correction,
                              const Settings& settings) {
    if (!std::isfinite(correction)) {
      return {Failure::not_finite, t,
              fmt::format("at t = {:.9g} s Newton's correction is not finite; try a smaller step", t)};
    }
    Eigen::Index largest = 0;
    delta.cwiseAbs().maxCoeff(&largest);
    return {
        Failure::not_converged, t,
        fmt::format("at t = {:.9g} s Newton's method did not converge: after {} iterations the correction is {:.3g}, "
                    "the tolerance {:.3g}; the largest correction is that of {}; try a smaller step, the exact "
                    "jacobian or a larger tolerance",
                    t, settings.max_iterations, correction, settings.tolerance,
                    problem.describe_unknown(static_cast<int>(largest)))};
  }

  // The last accepted step stays in `state`.
  static Status give_up(Status status, const Vector& q_n, const Vector& v_n, State& state, PhaseClock& clock,
                        Statistics& statistics) {
    finish(clock, statistics);
    state.q.assign(q_n.begin(), q_n.end());
    state.v.assign(v_n.begin(), v_n.end());
    return status;
  }
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler() {
  return std::make_unique<ImplicitEuler>();
}

}  // namespace poinsot
