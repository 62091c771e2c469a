#include "integrators/methods/explicit_runge_kutta.h"

#include <algorithm>

#include "integrators/stepping/controlled_run.h"
#include "integrators/stepping/explicit_stepper.h"

namespace poinsot {
namespace {

// So many rejections in a row are more than error control needs to find a step: a singular position may be near,
// which a step of the usual length passes.
constexpr int kDifficult = 2;

class ControlledPair : public ExplicitStepper {
 public:
  using ExplicitStepper::ExplicitStepper;

  // A start where the trial step fails is left to the steps, which will tell why.
  double first_step(double end) {
    double h = 0;
    return ExplicitStepper::first_step(end, h).ok() ? h : 1e-6 * end;
  }
  Status attempt(double to, int rejections, double& error) {
    return ExplicitStepper::attempt(to, rejections < kDifficult ? Stages::as_they_come : Stages::projected, error);
  }
  double retry(double h, int rejections, double usual) const {
    return rejections == kDifficult ? std::max(h, usual) : h;
  }
  double adopt(double, double wanted) const { return wanted; }
};

class ExplicitRungeKutta final : public Integrator {
 public:
  explicit ExplicitRungeKutta(const RungeKuttaPair& pair) : pair_(pair) {}

  Status run(const Run& run) override {
    PhaseClock clock;
    ControlledPair method(pair_, run.problem, run.systems, run.settings.rtol, run.settings.absolute_tolerance(),
                          run.statistics, clock);
    if (Status status = method.prepare(); !status.ok()) return status;
    if (Status status = method.start(run.state); !status.ok()) return status;
    return controlled_run(method, pair_.rule, run, clock);
  }

 private:
  const RungeKuttaPair& pair_;
};

}  // namespace

std::unique_ptr<Integrator> make_explicit_runge_kutta(const RungeKuttaPair& pair) {
  return std::make_unique<ExplicitRungeKutta>(pair);
}

}  // namespace poinsot
