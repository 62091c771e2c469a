#include "integrators/methods/explicit_runge_kutta.h"

#include <fmt/format.h>

#include "integrators/stepping/controlled_methods.h"
#include "integrators/stepping/controlled_run.h"

namespace poinsot {
namespace {

class ExplicitRungeKutta final : public Integrator {
 public:
  explicit ExplicitRungeKutta(const RungeKuttaPair& pair) : pair_(pair) {}

  Status run(const Run& run) override {
    PhaseClock clock;
    ControlledPair method(pair_, run.problem, run.systems, run.settings.rtol, run.settings.absolute_tolerance(),
                          run.statistics, clock);
    if (Status status = method.prepare(); !status.ok()) return status;
    if (Status status = method.start(run.state); !status.ok()) return status;
    bool told = false;
    return controlled_run(method, pair_.rule, run, clock, [&] {
      if (method.stiff() && !told) run.tell(stiffness_notice(method));
      told = told || method.stiff();
      return false;
    });
  }

 private:
  std::string stiffness_notice(const ControlledPair& method) const {
    return fmt::format(
        "the motion is stiff: at t = {:.3g} s the steps of {} are {:.2g} s long for the sake of stability, not of "
        "accuracy; the result is as accurate as asked for, but integrator radau5 takes longer steps",
        method.state().t, pair_.name, method.last_step());
  }

  const RungeKuttaPair& pair_;
};

}  // namespace

std::unique_ptr<Integrator> make_explicit_runge_kutta(const RungeKuttaPair& pair) {
  return std::make_unique<ExplicitRungeKutta>(pair);
}

}  // namespace poinsot
