#include "integrators/methods/radau5.h"

#include "integrators/stepping/controlled_run.h"
#include "integrators/stepping/radau_stepper.h"

namespace poinsot {
namespace {

constexpr StepRule kRule{0.9, 0.25, 0, 0.5, 8, true};
constexpr double kSameStep = 1.2;  // growth up to which a kept matrix saves more than a longer step does

class Method : public RadauStepper {
 public:
  using RadauStepper::RadauStepper;

  Status attempt(double to, int, double& error) { return RadauStepper::attempt(to, error); }
  double retry(double h, int, double) const { return h; }
  double adopt(double h, double wanted) const {
    return converges_fast() && wanted >= h && wanted <= kSameStep * h ? h : wanted;
  }
};

class Radau5 final : public Integrator {
 public:
  Status run(Problem& problem, LinearSolver& solver, const Settings& settings, State& state, const Observer& observe,
             Statistics& statistics) override {
    PhaseClock clock;
    Method method(problem, solver, settings.linear_solver, settings.rtol, settings.absolute_tolerance(), statistics,
                  clock);
    if (Status status = method.prepare(); !status.ok()) return status;
    if (Status status = method.start(state); !status.ok()) return status;
    return controlled_run(method, kRule, problem, settings, state, observe, statistics, clock);
  }
};

}  // namespace

std::unique_ptr<Integrator> make_radau5() {
  return std::make_unique<Radau5>();
}

}  // namespace poinsot
