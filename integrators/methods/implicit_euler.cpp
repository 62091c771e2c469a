#include "integrators/methods/implicit_euler.h"

#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/newton_loop.h"

namespace poinsot {
namespace {

using Vector = Eigen::VectorXd;

class ImplicitEuler final : public Integrator {
 public:
  Status run(Problem& problem, LinearSystems& systems, const Settings& settings, State& state, const Observer& observe,
             Statistics& statistics) override {
    const JacobianEntry& policy = jacobians().require(settings.jacobian);
    const TimeGrid grid(settings);
    const double h = grid.step();
    const StepScale scale{1, h, h * h};
    PhaseClock clock;
    StepSystem system(problem, systems.add(policy.workload()), policy.matrix, statistics, clock);
    if (Status status = system.prepare(); !status.ok()) return status;
    NewtonLoop newton(problem, system, settings, policy.refresh, statistics);

    SteppedState x(state);
    Vector dq(x.nv);
    const auto stand = [&](double t) -> Problem& {
      x.stand(problem, t);
      return problem;
    };
    const auto step = [&](double t) -> Status {
      const auto advance = [&] {  // v and q that belong to the acceleration in z
        x.v.noalias() = x.v_n + h * x.z.head(x.nv);
        dq.noalias() = h * x.v;
        problem.retract(span(x.q_n), span(dq), span(x.q));
      };
      const auto residual = [&](Vector& r) {
        advance();
        stand(t).step_residual(scale, x.a(), x.lambda(), span(r));
      };
      const auto matrix = [&]() -> Status {
        if (policy.refresh != Refresh::before_step) return system.refresh(t, scale, span(dq), x.a(), x.lambda());
        problem.set_position(t, span(x.q_n));
        problem.set_velocity(span(x.v_n));
        return system.refresh(t, scale, {}, x.a(), x.lambda());
      };
      const auto correct = [&](Vector& delta) -> Status {
        problem.lower(span(dq), span(delta, 0, x.nv));
        x.z += delta;
        return {};
      };
      Status status = newton.solve(t, scale.position, x.q, residual, matrix, correct);
      if (status.ok()) advance();
      return status;
    };
    return fixed_steps(x, grid, state, observe, statistics, clock, step, stand);
  }
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler() {
  return std::make_unique<ImplicitEuler>();
}

}  // namespace poinsot
