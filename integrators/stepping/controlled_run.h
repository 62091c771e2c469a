// A run of a one-step method under error control: steps tried, refused and accepted, samples between them, kinks and
// jumps of the data stepped onto, pulses and what laws do on the way not stepped over, an exact end.
//
// A Method is a stepper with: Status attempt(to, rejections, error), Status complete(error), Status interpolate(t),
// interpolated(), take_back(), settle(), cross(t), state(); double first_step(end, singular_for), Run's; double
// retry(h, rejections, usual), the step to try after so many rejections in a row; double adopt(h, wanted), the step
// after a completed one of length h.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/interruption.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/observe.h"
#include "integrators/stepping/passed_laws.h"
#include "integrators/stepping/progress.h"
#include "integrators/stepping/pulses.h"
#include "integrators/stepping/sample_times.h"
#include "integrators/stepping/singular_position.h"
#include "integrators/stepping/step_control.h"
#include "integrators/stepping/sticking.h"
#include "integrators/stepping/still_watch.h"
#include "integrators/stepping/switch_times.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

inline void tell_long_way(const Run& run, double t, double steps) {
  run.tell(
      fmt::format("up to t = {:.6g} s {} steps were done, and as it goes on the end is some {:.0e} further ones away",
                  t, run.statistics.steps, steps));
}

// What lies before a run, whichever method is at it: the clock, output times, switches of the data, who is given what.
class Course {
 public:
  Course(const Run& run, PhaseClock& clock)
      : every_step(run.settings.every == 0),
        times(run.settings.every, run.settings.end),
        switches(run.problem.model(), run.settings.end, run.tell),
        pulses(run.problem.model(), run.settings.end, run.settings.rtol, run.tell),
        laws(run.problem.model(), run.settings.end, run.settings.rtol, run.settings.absolute_tolerance(), run.tell),
        run_(run),
        clock_(clock),
        still_(run.problem, run.tell),
        progress_(run.settings.end),
        sticking_(run.problem.model(), run.settings.linear(), instant_of(run.settings.end)) {}

  void give_out(const State& at) { give_out(at, at.t); }
  void give_out(const State& at, double t) {
    clock_.pause();
    open_multipliers_.look(at, run_.tell);
    sample(run_.observe, run_.problem, at, run_.statistics, t);
    clock_.resume();
  }
  // No consistent state was found beside `at`, the motion at the next output time.
  Status singular_sample(const State& at) const {
    const int rows = static_cast<int>(run_.problem.model_rows().size());
    const int row = most_dependent_row(run_.problem, rows, at.t, span(at.q)).row;
    return poinsot::singular_sample(times.next(),
                                    row < 0 ? "" : run_.problem.describe_unknown(run_.problem.nv() + row));
  }
  // A step ended at `at`, where the problem stands.
  Status follow(const State& at) {
    still_.look(run_.problem, at);
    if (progress_.look(at.t)) {
      if (progress_.never_ends()) return never_beyond(run_.problem, at, progress_.limit());
      if (progress_.takes_long() && !std::exchange(long_told_, true)) tell_long_way(run_, at.t, progress_.steps_left());
    }
    return sticking_.look(run_.problem, at);
  }
  double turned(double h) const { return h * run_.problem.fastest_turn(); }  // rad, the fastest body at its speed now
  const Problem& problem() const { return run_.problem; }
  double end() const { return run_.settings.end; }
  // See Run::singular_for; 0 once the run is under way.
  double singular_for(double t) const { return t > 0 ? 0 : run_.singular_for; }
  Statistics& statistics() { return run_.statistics; }

  const bool every_step;
  SampleTimes times;
  SwitchTimes switches;
  Pulses pulses;
  PassedLaws laws;

 private:
  const Run& run_;
  PhaseClock& clock_;
  StillWatch still_;
  Progress progress_;
  bool long_told_ = false;
  StickingWatch sticking_;
  OpenMultipliers open_multipliers_;
};

// From the method's state to the end, or to the first step after which leave() says so.
template <class Method, class Leave>
Status controlled_steps(Method& method, const StepRule& rule, Course& course, const Leave& leave) {
  constexpr double kForgotten = 0.8;
  const double end = course.end(), smallest = 16 * std::numeric_limits<double>::epsilon() * end;
  SampleTimes& times = course.times;
  StepController controller(rule);
  Creeping creeping(end);
  const double singular_for = course.singular_for(method.state().t);
  course.laws.begin(course.problem(), method.state());
  double h = method.first_step(end, singular_for);
  double usual = singular_for > 0 ? h : 0;  // length of the steps so far, those long ago forgotten
  int rejections = 0;                       // in a row
  while (method.state().t < end) {
    const double t = method.state().t;
    if (interruption_requested) return interrupted(t);
    const SwitchTimes::Switch turn = course.switches.first(t, std::min(t + 1.01 * h, end));
    const double stop = std::min(turn.before, end);
    const double wanted = t + 1.01 * h >= stop ? stop : t + h, to = course.pulses.reach(t, wanted);
    if (to < wanted) creeping.limited();
    if (to > t) {
      h = to - t;
      if (creeping.tries(t, h)) return step_too_small(t, h, {});
      double error = 0;
      Status status = method.attempt(to, rejections, error);
      if (status.ok() && error <= 1) status = method.complete(error);
      if (!status.ok() || !(error <= 1)) {
        if (status.failure == Failure::refused) return status;
        ++course.statistics().rejected_steps;
        h = status.ok() && std::isfinite(error) ? controller.rejected(h, error) : controller.failed(h);
        if (h < smallest) return step_too_small(t, h, status);
        h = method.retry(h, ++rejections, usual);
        continue;
      }
      if (const double seen = course.laws.reach(course.problem(), method.state()); seen < to) {
        method.take_back();
        ++course.statistics().rejected_steps;
        creeping.limited();
        h = seen - t;
        continue;
      }
      ++course.statistics().steps;
      course.statistics().largest_rotation = std::max(course.statistics().largest_rotation, course.turned(h));
      if (status = course.follow(method.state()); !status.ok()) return status;
      rejections = 0;
      usual = std::max(h, kForgotten * usual);
      creeping.completed(h);
      h = method.adopt(h, controller.accepted(h, error));
      for (; !course.every_step && times.next() < to; times.pass()) {
        if (status = method.interpolate(times.next()); !status.ok()) break;
        course.give_out(method.interpolated());
      }
      if (!status.ok()) {  // the step went over a place where no state can be found, as of angles that are singular
        if (status.failure == Failure::refused) return status;
        if (status.failure == Failure::singular_position) return course.singular_sample(method.interpolated());
        method.take_back();
        course.laws.take_back();
        --course.statistics().steps;
        ++course.statistics().rejected_steps;
        h = method.retry(controller.failed(to - t), ++rejections, 0);
        if (h < smallest) return step_too_small(t, h, status);
        continue;
      }
    }
    const bool crosses = to == turn.before;
    if (!(to > t) && !crosses) return step_too_small(t, h, {});  // the time itself is too coarse for it
    if (Status status = crosses ? method.cross(std::min(turn.after, end)) : method.settle(); !status.ok()) {
      return status;
    }
    if (course.every_step) {
      if (to > t) course.give_out(method.state());
    } else if (times.next() <= method.state().t) {
      course.give_out(method.state(), times.next());
      times.pass();
    }
    if (crosses) {  // what error control has learnt is of the motion before
      controller = StepController(rule);
      creeping = Creeping(end);
      course.laws.begin(course.problem(), method.state());
      h = method.first_step(end, 0);
    }
    if (leave()) return {};
  }
  return {};
}

// The method stands at the run's state.
template <class Method, class Leave>
Status controlled_run(Method& method, const StepRule& rule, const Run& run, PhaseClock& clock, const Leave& leave) {
  Course course(run, clock);
  clock.start();
  course.give_out(method.state());
  const Status status = controlled_steps(method, rule, course, leave);
  finish(clock, run.statistics);
  run.state = method.state();
  return status;
}

}  // namespace poinsot
