#include "integrators/explicit_runge_kutta.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/explicit_stepper.h"
#include "integrators/observe.h"
#include "integrators/sample_times.h"
#include "integrators/vectors.h"

namespace poinsot {
namespace {

// So many rejections in a row are more than error control needs to find a step: a singular position may be near.
constexpr int kDifficult = 2;

class ExplicitRungeKutta final : public Integrator {
 public:
  explicit ExplicitRungeKutta(const RungeKuttaPair& pair) : pair_(pair) {}

  Status run(Problem& problem, LinearSolver& solver, const Settings& settings, State& state, const Observer& observe,
             Statistics& statistics) override {
    PhaseClock clock;
    ExplicitStepper stepper(pair_, problem, solver, settings.rtol, settings.atol, statistics, clock);
    if (Status status = stepper.prepare(); !status.ok()) return status;
    const auto give_out = [&](const Point& at) {
      clock.lap(Phase::other);
      sample(observe, problem, at.t, span(at.q), span(at.v), stepper.points().a(at), stepper.points().lambda(at),
             statistics);
      clock.skip();
    };
    stepper.start(0, state);
    clock.start();
    give_out(stepper.state());
    Status status = integrate(stepper, settings, give_out, statistics);
    finish(clock, statistics);

    stepper.points().give(stepper.state(), state);
    return status;
  }

 private:
  template <class GiveOut>
  Status integrate(ExplicitStepper& stepper, const Settings& settings, const GiveOut& give_out,
                   Statistics& statistics) const {
    const double end = settings.end, smallest = 16 * std::numeric_limits<double>::epsilon() * end;
    SampleTimes times(settings.every, end);
    StepController controller(pair_.rule);
    // A start where the trial step fails is left to the steps, which will tell why.
    double h = 0;
    if (!stepper.first_step(end, h).ok()) h = 1e-6 * end;
    Creeping creeping;
    double completed = 0;  // the last step
    int rejections = 0;    // in a row
    while (stepper.state().t < end) {
      const double t = stepper.state().t;
      const double to = t + 1.01 * h >= end ? end : t + h;
      h = to - t;
      if (creeping.tries(h)) return step_too_small(t, h, {});
      using enum ExplicitStepper::Stages;
      double error = 0;
      Status status = stepper.attempt(to, rejections < kDifficult ? as_they_come : projected, error);
      if (status.ok() && error <= 1) status = stepper.complete();
      if (!status.ok() || !(error <= 1)) {
        ++statistics.rejected_steps;
        h = status.ok() && std::isfinite(error) ? controller.rejected(h, error) : controller.failed(h);
        if (h < smallest) return step_too_small(t, h, status);
        if (++rejections == kDifficult) h = std::max(h, completed);
        continue;
      }
      ++statistics.steps;
      rejections = 0;
      completed = h;
      creeping.completed(h);
      h = controller.accepted(h, error);
      for (; settings.every > 0 && times.next() < to; times.pass()) {
        if (status = stepper.interpolate(times.next()); !status.ok()) return status;
        give_out(stepper.interpolated());
      }
      stepper.settle();
      if (settings.every == 0 || times.next() == to) {
        times.pass();
        give_out(stepper.state());
      }
    }
    return {};
  }

  const RungeKuttaPair& pair_;
};

}  // namespace

std::unique_ptr<Integrator> make_explicit_runge_kutta(const RungeKuttaPair& pair) {
  return std::make_unique<ExplicitRungeKutta>(pair);
}

}  // namespace poinsot
