// A run of a one-step method under error control: steps tried, refused and accepted, samples between them, kinks and
// jumps of the data stepped onto, pulses and what laws do on the way not stepped over, an exact end.
//
// A Method is a stepper with: Status attempt(to, rejections, error), trial_end(), Status complete(error),
// Status interpolate(t), Status lead(t), interpolated(), take_back(), settle(), bool choose_rows(), cross(t),
// bool cross_singular(from, t, singular_for), near_singular(), state();
// double first_step(end, singular_for), Run's; double retry(h, rejections, usual), the step to try after so many
// rejections in a row; double adopt(h, wanted), the step after a completed one of length h.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/interruption.h"
#include "integrators/stepping/course.h"
#include "integrators/stepping/step_control.h"

namespace poinsot {

// From the method's state to the end, or to the first step after which leave() says so.
template <class Method, class Leave>
Status controlled_steps(Method& method, const StepRule& rule, Course& course, const Leave& leave) {
  constexpr double kForgotten = 0.8, kBeside = 2e-3;  // kBeside: rad
  constexpr int kAsksForRows =
      4;  // rejections: of redundant rows the kept ones may all but depend on one another ahead
  const double end = course.end(), smallest = 16 * std::numeric_limits<double>::epsilon() * end;
  SampleTimes& times = course.times;
  StepController controller(rule);
  Creeping creeping(end);
  const double singular_for = course.singular_for(method.state().t);
  course.begin_laws(method.state());
  double h = method.first_step(end, singular_for);
  double usual = singular_for > 0 ? h : 0;  // length of the steps so far, those long ago forgotten
  int rejections = 0;                       // in a row
  double asked_at = -1;
  bool cut = false;  // h is what laws leave of a step
  // What error control has learnt is of the motion before.
  const auto begin_anew = [&](double singular) {
    controller = StepController(rule);
    creeping = Creeping(end);
    course.begin_anew(method.state());
    h = method.first_step(end, singular);
    rejections = 0;
    cut = false;
  };
  // Over a switch of a law at `to` that lies at a singular position; whether it does. What is to be given out before it
  // is, first.
  const auto over_singular = [&](Before from, double to) {
    double singular = 0;
    if (!course.every_step && times.next() < to) return false;
    if (!method.cross_singular(from, to, singular)) return false;
    if (course.every_step) course.give_out(method.state());
    for (; !course.every_step && times.next() <= method.state().t; times.pass())
      course.give_out(method.state(), times.next());
    begin_anew(singular);
    return true;
  };
  const auto beside_switch = [&](double stop) {
    const double to = course.law_switches.crossed_within(kBeside / course.problem().fastest_turn());
    return to < stop && (over_singular(Before::step, to) || over_singular(Before::now, to));
  };
  while (method.state().t < end) {
    const double t = method.state().t;
    if (interruption_requested) return interrupted(t);
    const SwitchTimes::Switch turn = course.switches.first(t, std::min(t + 1.01 * h, end));
    const double stop = std::min(turn.before, end), beyond_law = course.law_switches.beyond();
    if (method.near_singular() && beside_switch(stop)) continue;
    const bool leads = beyond_law < stop;  // to a switch of a law that is as near as that
    const double wanted = leads ? t : t + (cut ? 1 : 1.01) * h >= stop ? stop : t + h;
    const double to = course.pulses.reach(t, wanted);
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
        if (const double seen = course.switched(status, error, to, method); seen < to) {
          h = seen - t;
          cut = true;
          continue;
        }
        if (!status.ok() && beside_switch(stop)) continue;
        if (rejections == kAsksForRows && std::exchange(asked_at, t) != t && method.choose_rows()) {
          h = std::max(h, usual);
          rejections = 0;
          continue;
        }
        h = status.ok() && std::isfinite(error) ? controller.rejected(h, error) : controller.failed(h);
        if (h < smallest) return course.too_small(t, to, h, status);
        h = method.retry(h, ++rejections, usual);
        continue;
      }
      if (const double seen = course.seen(method.state()); seen < to) {
        method.take_back();
        ++course.statistics().rejected_steps;
        creeping.limited();
        h = seen - t;
        cut = true;
        continue;
      }
      cut = false;
      course.accept_laws();
      ++course.statistics().steps;
      course.statistics().largest_rotation = std::max(course.statistics().largest_rotation, course.turned(h));
      if (status = course.follow(method.state()); !status.ok()) return status;
      rejections = 0;
      usual = std::max(h, kForgotten * usual);
      creeping.completed(h);
      h = course.law_switches.length(method.adopt(h, controller.accepted(h, error)));
      for (; !course.every_step && times.next() < to; times.pass()) {
        if (status = method.interpolate(times.next()); !status.ok()) break;
        course.give_out(method.interpolated());
      }
      if (!status.ok()) {  // the step went over a place where no state can be found, as of angles that are singular
        if (status.failure == Failure::refused) return status;
        if (status.failure == Failure::singular_position) return course.singular_sample(method.interpolated());
        method.take_back();
        course.take_back_laws();
        --course.statistics().steps;
        ++course.statistics().rejected_steps;
        h = method.retry(controller.failed(to - t), ++rejections, 0);
        if (h < smallest) return step_too_small(t, h, status);
        continue;
      }
    }
    const bool crosses = leads || to == turn.before;
    if (!(to > t) && !crosses) return step_too_small(t, h, {});  // the time itself is too coarse for it
    for (; leads && !course.every_step && times.next() < beyond_law; times.pass()) {
      if (Status status = method.lead(times.next()); !status.ok()) return status;
      course.give_out(method.interpolated());
    }
    const double other_side = leads ? beyond_law : std::min(turn.after, end);
    if (Status status = course.driver_jumps.look(crosses ? other_side : method.state().t); !status.ok()) return status;
    if (Status status = crosses ? method.cross(other_side) : method.settle(); !status.ok()) {
      const bool singular = leads && status.failure == Failure::singular_position;
      if (!singular || !(over_singular(Before::step, other_side) || over_singular(Before::now, other_side)))
        return status;
      continue;
    }
    if (course.every_step) {
      if (to > t) course.give_out(method.state());
    } else if (times.next() <= method.state().t) {
      course.give_out(method.state(), times.next());
      times.pass();
    }
    if (crosses) begin_anew(0);
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
