#include "integrators/implicit_euler.h"

#include "integrators/newton_loop.h"
#include "integrators/observe.h"
#include "integrators/time_grid.h"

namespace poinsot {
namespace {

using Vector = Eigen::VectorXd;

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
    NewtonLoop newton(problem, system, settings, policy.refresh, statistics);

    const Eigen::Index nv = problem.nv(), nc = problem.nc();
    Vector q = Eigen::Map<Vector>(state.q.data(), problem.nq()), v = Eigen::Map<Vector>(state.v.data(), nv);
    Vector z(nv + nc);  // (a, λ)
    z << Eigen::Map<Vector>(state.a.data(), nv), Eigen::Map<Vector>(state.lambda.data(), nc);
    const std::span<double> a = span(z, 0, nv), lambda = span(z, nv, nc);
    Vector q_n = q, v_n = v, dq(nv);

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
      const auto residual = [&](Vector& r) {
        advance();
        problem.set_position(t, span(q));
        problem.set_velocity(span(v));
        problem.step_residual(scale, a, lambda, span(r));
      };
      const auto matrix = [&]() -> Status {
        if (policy.refresh != Refresh::before_step) return system.refresh(t, scale, span(dq), a, lambda);
        problem.set_position(t, span(q_n));
        problem.set_velocity(span(v_n));
        return system.refresh(t, scale, {}, a, lambda);
      };
      const auto correct = [&](Vector& delta) -> Status {
        problem.lower(span(dq), span(delta, 0, nv));
        z += delta;
        return {};
      };
      if (Status status = newton.solve(t, scale.position, q, residual, matrix, correct); !status.ok()) {
        finish(clock, statistics);  // the last accepted step stays in `state`
        state.q.assign(q_n.begin(), q_n.end());
        state.v.assign(v_n.begin(), v_n.end());
        return status;
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
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler() {
  return std::make_unique<ImplicitEuler>();
}

}  // namespace poinsot
