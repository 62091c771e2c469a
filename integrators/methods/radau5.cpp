#include "integrators/methods/radau5.h"

#include "integrators/stepping/controlled_run.h"
#include "integrators/stepping/radau_stepper.h"

namespace poinsot {
namespace {

constexpr StepRule kRule{0.9, 0.25, 0, 0.5, 8, true};
constexpr double kSameStep = 1.2;  // growth up to which a kept matrix saves more than a longer step does

class ControlledRadau : public RadauStepper {
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
  Status run(const Run& run) override {
    PhaseClock clock;
    const Settings& settings = run.settings;
    ControlledRadau method(run.problem, run.systems, settings.rtol, settings.absolute_tolerance(), run.statistics,
                           clock);
    if (Status status = method.prepare(); !status.ok()) return status;
    if (Status status = method.start(run.state); !status.ok()) return status;
    return controlled_run(method, kRule, run, clock);
  }
};

}  // namespace

std::unique_ptr<Integrator> make_radau5() {
  return std::make_unique<Radau5>();
}

}  // namespace poinsot
