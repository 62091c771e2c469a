#include "integrators/half_implicit.h"

#include <utility>

#include "integrators/broyden.h"
#include "integrators/newton_loop.h"
#include "integrators/observe.h"
#include "integrators/time_grid.h"
#include "integrators/velocity_rows.h"

namespace poinsot {
namespace {

using Vector = Eigen::VectorXd;

class HalfImplicit final : public Integrator {
 public:
  Status run(Problem& problem, LinearSolver& solver, const Settings& settings, State& state, const Observer& observe,
             Statistics& statistics) override {
    const TimeGrid grid(settings);
    const double h = grid.step();
    PhaseClock clock;
    const std::unique_ptr<Problem> second = problem.clone();
    struct End {  // of a step; where one step ends the next begins, and the problem stands there already
      Problem& problem;
      StepSystem system;
    } ends[] = {{problem, {problem, solver, MatrixKind::consistent, statistics, clock}},
                {*second, {*second, solver, MatrixKind::consistent, statistics, clock}}};
    End *here = &ends[0], *there = &ends[1];
    if (Status status = here->system.prepare(); !status.ok()) return status;
    NewtonLoop newton(problem, here->system, settings, Refresh::every_step, statistics);
    Broyden broyden(problem.nv() + problem.nc(), problem.nv());
    const std::vector<int> free_rows = velocity_rows(problem);

    const Eigen::Index nv = problem.nv(), nc = problem.nc();
    Vector q = Eigen::Map<Vector>(state.q.data(), problem.nq()), v = Eigen::Map<Vector>(state.v.data(), nv);
    Vector z(nv + nc);  // (a, λ)
    z << Eigen::Map<Vector>(state.a.data(), nv), Eigen::Map<Vector>(state.lambda.data(), nc);
    const std::span<double> a = span(z, 0, nv), lambda = span(z, nv, nc);
    Vector q_n = q, v_n = v, dq(nv), rows(nc);

    problem.set_position(0, span(q));
    problem.set_velocity(span(v));
    sample(observe, problem, 0, span(q), span(v), a, lambda, statistics);

    clock.start();
    for (std::int64_t n = 1; n <= grid.steps; ++n) {
      const double t = grid.time(n);
      q_n.swap(q);
      v_n.swap(v);
      const auto advance = [&] {
        v.noalias() = v_n + h * z.head(nv);
        dq.noalias() = h * v;
        problem.retract(span(q_n), span(dq), span(q));
        there->problem.set_position(t, span(q));
      };
      const auto residual = [&](Vector& r) {
        advance();
        here->problem.equations_of_motion(a, lambda, span(r, 0, nv));
        there->problem.position_residual(span(r, nv, nc));
        r.tail(nc) /= h * h;
        if (free_rows.empty()) return;
        there->problem.set_velocity(span(v));
        there->problem.velocity_residual(span(rows));
        for (int row : free_rows) r[nv + row] = rows[row] / h;
      };
      const auto matrix = [&] { return here->system.refresh(grid.time(n - 1), {}, {}, a, lambda); };
      const auto correct = [&](Vector& delta) -> Status {
        broyden.improve(delta);
        z += delta;
        return {};
      };
      broyden.restart();
      if (Status status = newton.solve(t, h * h, q, residual, matrix, correct); !status.ok()) {
        finish(clock, statistics);  // the last accepted step stays in `state`
        state.q.assign(q_n.begin(), q_n.end());
        state.v.assign(v_n.begin(), v_n.end());
        return status;
      }
      advance();
      ++statistics.steps;
      std::swap(here, there);
      here->problem.set_velocity(span(v));
      if (here->problem.has_discrete_state() && here->problem.accept(t, span(q), span(v), a)) {
        here->problem.set_position(t, span(q));
        here->problem.set_velocity(span(v));
      }
      if (grid.sampled(n)) {
        clock.lap(Phase::other);
        sample(observe, here->problem, t, span(q), span(v), a, lambda, statistics);
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

std::unique_ptr<Integrator> make_half_implicit() {
  return std::make_unique<HalfImplicit>();
}

}  // namespace poinsot
