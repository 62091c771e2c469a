#include "integrators/methods/half_implicit.h"

#include <utility>

#include "integrators/stepping/broyden.h"
#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/newton_loop.h"
#include "integrators/stepping/velocity_rows.h"

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
    std::vector<int> free_rows = velocity_rows(problem);
    int revision = problem.revision();

    SteppedState x(state);
    Vector dq(x.nv), rows(x.nc);
    double t_n = 0;
    x.stand(problem, 0);
    const auto stand = [&](double) -> Problem& { return here->problem; };  // it does after every step
    const auto step = [&](double t) -> Status {
      const auto advance = [&] {
        x.v.noalias() = x.v_n + h * x.z.head(x.nv);
        dq.noalias() = h * x.v;
        problem.retract(span(x.q_n), span(dq), span(x.q));
        there->problem.set_position(t, span(x.q));
      };
      const auto residual = [&](Vector& r) {
        advance();
        here->problem.equations_of_motion(x.a(), x.lambda(), span(r, 0, x.nv));
        there->problem.position_residual(span(r, x.nv, x.nc));
        r.tail(x.nc) /= h * h;
        if (free_rows.empty()) return;
        there->problem.set_velocity(span(x.v));
        there->problem.velocity_residual(span(rows));
        for (int row : free_rows) r[x.nv + row] = rows[row] / h;
      };
      const auto matrix = [&] { return here->system.refresh(t_n, {}, {}, x.a(), x.lambda()); };
      const auto correct = [&](Vector& delta) -> Status {
        broyden.improve(delta);
        x.z += delta;
        return {};
      };
      broyden.restart();
      if (here->problem.revision() != revision) {
        revision = here->problem.revision();
        free_rows = velocity_rows(here->problem);
      }
      if (Status status = newton.solve(t, h * h, x.q, residual, matrix, correct); !status.ok()) return status;
      advance();
      std::swap(here, there);
      here->problem.set_velocity(span(x.v));
      t_n = t;
      return {};
    };
    return fixed_steps(x, grid, state, observe, statistics, clock, step, stand);
  }
};

}  // namespace

std::unique_ptr<Integrator> make_half_implicit() {
  return std::make_unique<HalfImplicit>();
}

}  // namespace poinsot
