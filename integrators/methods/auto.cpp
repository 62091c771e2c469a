#include "integrators/methods/auto.h"

#include "integrators/methods/dop853.h"
#include "integrators/stepping/controlled_methods.h"
#include "integrators/stepping/controlled_run.h"

namespace poinsot {
namespace {

class Auto final : public Integrator {
 public:
  Status run(const Run& run) override {
    PhaseClock clock;
    Course course(run, clock);
    const RungeKuttaPair& pair = dop853_pair();
    ControlledPair method(pair, run.problem, run.systems, run.settings.rtol, run.settings.absolute_tolerance(),
                          run.statistics, clock);
    if (Status status = method.prepare(); !status.ok()) return status;
    if (Status status = method.start(run.state); !status.ok()) return status;
    clock.start();
    course.give_out(method.state());
    Status status = steps(method, pair.name, pair.rule, course, run, [&] { return method.stiff(); });
    if (status.ok() && run.state.t < run.settings.end) status = go_on(course, run, clock);
    finish(clock, run.statistics);
    return status;
  }

 private:
  static Status go_on(Course& course, const Run& run, PhaseClock& clock) {
    ControlledRadau method(run.problem, run.systems, run.settings.rtol, run.settings.absolute_tolerance(),
                           run.statistics, clock);
    if (Status status = method.prepare(); !status.ok()) return status;
    if (Status status = method.start(run.state); !status.ok()) return status;
    return steps(method, "radau5", ControlledRadau::kRule, course, run, [] { return false; });
  }

  template <class Method, class Leave>
  static Status steps(Method& method, std::string_view name, const StepRule& rule, Course& course, const Run& run,
                      const Leave& leave) {
    const double from = method.state().t;
    const std::int64_t before = run.statistics.steps;
    const Status status = controlled_steps(method, rule, course, leave);
    run.state = method.state();
    run.statistics.methods.push_back({name, from, run.state.t, run.statistics.steps - before});
    return status;
  }
};

}  // namespace

std::unique_ptr<Integrator> make_auto_integrator() {
  return std::make_unique<Auto>();
}

}  // namespace poinsot
