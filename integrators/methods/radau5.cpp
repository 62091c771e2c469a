#include "integrators/methods/radau5.h"

#include <utility>

#include "integrators/methods/dop853.h"
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
                           clock, dop853_pair());
    if (Status status = method.prepare(); !status.ok()) return status;
    if (Status status = method.start(run.state); !status.ok()) return status;
    bool told = false;
    return controlled_run(method, ControlledRadau::kRule, run, clock, [&] {
      if (method.passes() && !std::exchange(told, true)) {
        run.tell(passing_notice(dop853_pair(), method.state().t));
      }
      return false;
    });
  }
};

}  // namespace

std::unique_ptr<Integrator> make_radau5() {
  return std::make_unique<Radau5>();
}

}  // namespace poinsot
