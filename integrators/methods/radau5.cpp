#include "integrators/methods/radau5.h"

#include "integrators/stepping/controlled_methods.h"
#include "integrators/stepping/controlled_run.h"

namespace poinsot {
namespace {

class Radau5 final : public Integrator {
 public:
  Status run(const Run& run) override {
    PhaseClock clock;
    const Settings& settings = run.settings;
    ControlledRadau method(run.problem, run.systems, settings.rtol, settings.absolute_tolerance(), run.statistics,
                           clock);
    if (Status status = method.prepare(); !status.ok()) return status;
    if (Status status = method.start(run.state); !status.ok()) return status;
    return controlled_run(method, ControlledRadau::kRule, run, clock, [] { return false; });
  }
};

}  // namespace

std::unique_ptr<Integrator> make_radau5() {
  return std::make_unique<Radau5>();
}

}  // namespace poinsot
