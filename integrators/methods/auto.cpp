#include "integrators/methods/auto.h"

#include <optional>
#include <utility>

#include "integrators/methods/dop853.h"
#include "integrators/stepping/controlled_methods.h"
#include "integrators/stepping/controlled_run.h"

namespace poinsot {
namespace {

constexpr std::int64_t kFirstTrial = 300, kTrialsApart = 4;  // steps of dop853; factor between them
constexpr std::int64_t kTrial = 6;                           // steps of radau5, in which its length settles
constexpr double kLonger = 4;
constexpr double kOfRounding =
    1e-12;  // rtol below which steps are as short for rounding's sake; then there is no trial

class Auto final : public Integrator {
 public:
  Status run(const Run& run) override {
    PhaseClock clock;
    Course course(run, clock);
    const Status status = both(course, run, clock);
    finish(clock, run.statistics);
    return status;
  }

 private:
  static Status both(Course& course, const Run& run, PhaseClock& clock) {
    const double rtol = run.settings.rtol, atol = run.settings.absolute_tolerance(), end = run.settings.end;
    const RungeKuttaPair& pair = dop853_pair();
    ControlledPair dop853(pair, run.problem, run.systems, rtol, atol, run.statistics, clock);
    std::optional<ControlledRadau> radau5;
    if (Status status = dop853.prepare(); !status.ok()) return status;
    clock.start();
    bool begun = false, told = false;
    for (std::int64_t trial = kFirstTrial;;) {
      if (Status status = dop853.start(run.state); !status.ok()) return status;
      if (!std::exchange(begun, true)) course.give_out(dop853.state());
      std::int64_t steps = 0;
      const double from = run.state.t;
      if (Status status =
              go_on(dop853, pair.name, pair.rule, course, run,
                    [&] {
                      ++steps;
                      return dop853.stiff() ||
                             (rtol >= kOfRounding && (steps == trial || (!radau5 && dop853.held_by_the_decayed())));
                    });
          !status.ok() || run.state.t == end)
        return status;

      if (steps == trial) trial *= kTrialsApart;
      if (!radau5) {
        radau5.emplace(run.problem, run.systems, rtol, atol, run.statistics, clock, pair);
        if (Status status = radau5->prepare(); !status.ok()) return status;
      }
      if (Status status = radau5->start(run.state); !status.ok()) return status;
      const double enough = kLonger * (run.state.t - from) / static_cast<double>(steps);
      const bool stays = dop853.stiff();
      double before = run.state.t;
      steps = 0;
      const auto is_no_better = [&] {
        if (radau5->passes() && !std::exchange(told, true)) run.tell(passing_notice(pair, radau5->state().t));
        const double h = radau5->state().t - std::exchange(before, radau5->state().t);
        return ++steps == kTrial && !stays && h < enough;
      };
      const double since = run.state.t;
      const Status status = go_on(*radau5, "radau5", ControlledRadau::kRule, course, run, is_no_better);
      // Singular positions that stop radau5 dop853 can pass; where it cannot, it says why.
      const bool other_way = status.failure == Failure::step_size_too_small && (!stays || run.state.t > since);
      if ((!status.ok() && !other_way) || run.state.t == end) return status;
    }
  }

  template <class Method, class Leave>
  static Status go_on(Method& method, std::string_view name, const StepRule& rule, Course& course, const Run& run,
                      const Leave& leave) {
    const double from = method.state().t;
    const std::int64_t before = run.statistics.steps;
    const Status status = ControlledSteps(method, rule, course).march(leave);
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
