#include "integrators/explicit_runge_kutta.h"

#include <fmt/format.h>

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
// So many steps in a row that are so much smaller than the longest one do not pass a jump of the forces, which takes a
// few dozen: they creep towards a singular position, where less and less of the accelerations is more than rounding.
constexpr int kCreeping = 100;
constexpr double kTiny = 1e-6;

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
    double completed = 0, longest = 0;  // steps so far: the last, the longest
    int rejections = 0, tiny = 0;       // in a row
    while (stepper.state().t < end) {
      const double t = stepper.state().t;
      const double to = t + 1.01 * h >= end ? end : t + h;
      h = to - t;
      tiny = h < kTiny * longest ? tiny + 1 : 0;
      if (tiny > kCreeping) return stuck(t, h, {});
      using enum ExplicitStepper::Stages;
      double error = 0;
      Status status = stepper.attempt(to, rejections < kDifficult ? as_they_come : projected, error);
      if (status.ok() && error <= 1) status = stepper.complete();
      if (!status.ok() || !(error <= 1)) {
        ++statistics.rejected_steps;
        h = status.ok() && std::isfinite(error) ? controller.rejected(h, error) : controller.failed(h);
        if (h < smallest) return stuck(t, h, status);
        if (++rejections == kDifficult) h = std::max(h, completed);
        continue;
      }
      ++statistics.steps;
      rejections = 0;
      completed = h;
      longest = std::max(longest, h);
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

  static Status stuck(double t, double h, const Status& cause) {
    return {
        Failure::step_size_too_small, t,
        fmt::format("at t = {:.9g} s the steps became too small to get on with ({:.3g} s): the motion jumps or grows "
                    "without bound here, the mechanism comes to a singular position, near which accelerations are "
                    "lost to rounding, or the tolerances ask for more than the arithmetic has; larger tolerances or "
                    "an implicit integrator with a fixed step may pass{}",
                    t, h, cause.ok() ? "" : "; the last attempt: " + cause.message)};
  }

  const RungeKuttaPair& pair_;
};

}  // namespace

std::unique_ptr<Integrator> make_explicit_runge_kutta(const RungeKuttaPair& pair) {
  return std::make_unique<ExplicitRungeKutta>(pair);
}

}  // namespace poinsot
