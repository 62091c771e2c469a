// A run of a one-step method under error control: steps tried, refused and accepted, samples between them, kinks and
// jumps of the data stepped onto, pulses and what laws do on the way not stepped over, an exact end.
//
// A Method is a stepper with: Status attempt(to, rejections, error), trial_end(), Status complete(error),
// Status interpolate(t), Status lead(t), interpolated(), take_back(), give(), settle(), bool choose_rows(), cross(t),
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

template <class Method>
class ControlledSteps {
 public:
  ControlledSteps(Method& method, const StepRule& rule, Course& course)
      : method_(method),
        rule_(rule),
        course_(course),
        end_(course.end()),
        smallest_(16 * std::numeric_limits<double>::epsilon() * end_),
        controller_(rule),
        creeping_(end_) {
    const double singular_for = course.singular_for(t());
    course.begin_laws(method.state());
    h_ = method.first_step(end_, singular_for);
    usual_ = singular_for > 0 ? h_ : 0;
  }

  // From the method's state to the end, or to the first step after which leave() says so.
  template <class Leave>
  Status march(const Leave& leave) {
    while (t() < end_) {
      if (interruption_requested) return interrupted(t());
      bool anew = false;
      const Aim aim = aim_at_next(anew);
      if (anew) continue;
      if (aim.to > aim.from)
        if (Status status = step(aim, anew); !status.ok()) return status;
      if (anew) continue;
      if (!(aim.to > aim.from) && !aim.crosses) return step_too_small(aim.from, h_, {});  // time itself is too coarse
      if (Status status = stand(aim, anew); !status.ok()) return status;
      if (anew) continue;
      if (leave()) return {};
    }
    return {};
  }

 private:
  // Where the next step goes.
  struct Aim {
    double from, to;
    double stop;    // at the end of the run or before a switch of a function of time, whichever comes first
    double beyond;  // other side of the switch that is crossed then; of none, the end
    bool leads;     // to a switch of a law that is as near as that
    bool crosses;   // a switch, after this step or without one
  };

  double t() const { return method_.state().t; }

  // `anew`: a switch has been crossed in its place.
  Aim aim_at_next(bool& anew) {
    const double from = t();
    const SwitchTimes::Switch turn = course_.switches.first(from, std::min(from + 1.01 * h_, end_));
    const double stop = std::min(turn.before, end_), beyond_law = course_.law_switches.beyond();
    anew = method_.near_singular() && beside_switch(stop);
    if (anew) return {};
    const bool leads = beyond_law < stop;
    const double wanted = leads ? from : from + (cut_ ? 1 : 1.01) * h_ >= stop ? stop : from + h_;
    const double to = course_.aim(from, wanted);
    if (to < wanted) creeping_.limited();
    return {from, to, stop, leads ? beyond_law : std::min(turn.after, end_), leads, leads || to == turn.before};
  }

  // `anew`: it was not done, and the next is to be aimed.
  Status step(const Aim& aim, bool& anew) {
    h_ = aim.to - aim.from;
    if (creeping_.tries(aim.from, h_)) return too_small(aim, {});
    double error = 0;
    Status status = method_.attempt(aim.to, rejections_, error);
    if (status.ok() && error <= 1) status = method_.complete(error);
    anew = !status.ok() || !(error <= 1);
    if (anew) return reject(aim, status, error);
    if (const double seen = course_.seen(method_.state()); seen < aim.to) {
      method_.take_back();
      ++course_.statistics().rejected_steps;
      creeping_.limited();
      h_ = seen - aim.from;
      anew = cut_ = true;
      return {};
    }
    cut_ = false;
    course_.accept_laws();
    ++course_.statistics().steps;
    course_.statistics().largest_rotation = std::max(course_.statistics().largest_rotation, course_.turned(h_));
    if (status = course_.follow(method_.state()); !status.ok()) return status;
    rejections_ = 0;
    usual_ = std::max(h_, kForgotten * usual_);
    creeping_.completed(h_);
    h_ = course_.law_switches.length(method_.adopt(h_, controller_.accepted(h_, error)));
    return give_out_passed(aim, anew);
  }

  // Of a step that failed or is too inaccurate: with what the next one is tried.
  Status reject(const Aim& aim, const Status& status, double error) {
    if (status.failure == Failure::refused) return status;
    if (++course_.statistics().rejected_steps > course_.most_rejected()) return step_too_small(aim.from, h_, status);
    if (method_.near_singular() && creeping_.fails_beside(aim.from)) return too_small(aim, status);
    if (const double seen = course_.switched(status, error, aim.to, method_); seen < aim.to) {
      h_ = seen - aim.from;
      cut_ = true;
      return {};
    }
    if (!status.ok() && beside_switch(aim.stop)) return {};
    if (rejections_ == kAsksForRows && std::exchange(asked_at_, aim.from) != aim.from && method_.choose_rows()) {
      h_ = std::max(h_, usual_);
      rejections_ = 0;
      return {};
    }
    h_ = status.ok() && std::isfinite(error) ? controller_.rejected(h_, error) : controller_.failed(h_);
    if (h_ < smallest_) return too_small(aim, status);
    h_ = method_.retry(h_, ++rejections_, usual_);
    return {};
  }

  // Samples between the ends of the step that was done. `anew`: it went over a place where no state can be found, as of
  // angles that are singular, and is taken back. Beside a singular position the next ones go over it, too: an output
  // time that comes to it at too shallow an angle has none by any step.
  Status give_out_passed(const Aim& aim, bool& anew) {
    Status status;
    for (; !course_.every_step && course_.times.next() < aim.to; course_.times.pass()) {
      if (interruption_requested) return interrupted(course_.times.next());
      if (status = method_.interpolate(course_.times.next()); !status.ok()) break;
      course_.give_out(method_.interpolated());
    }
    if (status.ok() || status.failure == Failure::refused) return status;
    if (status.failure == Failure::singular_position ||
        (method_.near_singular() && often_without(course_.times.next())))
      return course_.singular_sample(method_.interpolated());
    anew = true;
    method_.take_back();
    course_.take_back_laws();
    --course_.statistics().steps;
    ++course_.statistics().rejected_steps;
    h_ = method_.retry(controller_.failed(aim.to - aim.from), ++rejections_, 0);
    return h_ < smallest_ ? too_small(aim, status) : Status{};
  }

  // The sample at t, beside a singular position, could not be made once more; whether that is too often.
  bool often_without(double t) {
    taken_back_ = std::exchange(no_sample_at_, t) == t ? taken_back_ + 1 : 1;
    return taken_back_ > kMostTakenBack;
  }

  // Steps have become too short, `cause` is what the last one failed of.
  Status too_small(const Aim& aim, const Status& cause) {
    if (no_sample_at_ == course_.times.next()) return course_.singular_sample(method_.state());
    return course_.too_small(aim.from, aim.to, h_, cause);
  }

  // At the end of the step, and beyond the switch there. `anew`: that took the place of all else.
  Status stand(const Aim& aim, bool& anew) {
    for (; aim.leads && !course_.every_step && course_.times.next() < aim.beyond; course_.times.pass()) {
      if (Status status = method_.lead(course_.times.next()); !status.ok()) return status;
      course_.give_out(method_.interpolated());
    }
    if (Status status = course_.driver_jumps.look(aim.crosses ? aim.beyond : t()); !status.ok()) return status;
    const bool turns = aim.crosses && !aim.leads;  // over a switch of a function of time
    if (turns) course_.driver_impulses.expect(method_.state(), aim.beyond);
    if (Status status = aim.crosses ? method_.cross(aim.beyond) : method_.settle(); !status.ok()) {
      const bool singular = aim.leads && status.failure == Failure::singular_position;
      anew = singular && over_singular(aim.beyond);
      return anew ? Status{} : status;
    }
    if (turns) course_.driver_impulses.look(method_.state());
    if (course_.every_step) {
      if (aim.to > aim.from) course_.give_out(method_.state());
    } else if (course_.times.next() <= t()) {
      if (!aim.crosses && !method_.give().ok()) return course_.singular_sample(method_.state());
      course_.give_out(method_.state(), course_.times.next());
      course_.times.pass();
    }
    if (aim.crosses) begin_anew(0);
    return {};
  }

  // What error control has learnt is of the motion before.
  void begin_anew(double singular_for) {
    controller_ = StepController(rule_);
    creeping_ = Creeping(end_);
    course_.begin_anew(method_.state());
    h_ = method_.first_step(end_, singular_for);
    rejections_ = 0;
    cut_ = false;
  }

  // Over the switch of a law that lies beside, before `stop`, where the position is singular; whether there is one.
  bool beside_switch(double stop) {
    const double to = course_.law_switches.crossed_within(kBeside / course_.problem().fastest_turn());
    return to < stop && over_singular(to);
  }
  // Over a switch of a law at `to` that lies at a singular position; whether it does. What is to be given out before
  // it is, first.
  bool over_singular(double to) {
    double singular_for = 0;
    if (!course_.every_step && course_.times.next() < to) return false;
    if (!method_.cross_singular(Before::step, to, singular_for) &&
        !method_.cross_singular(Before::now, to, singular_for))
      return false;
    if (course_.every_step) course_.give_out(method_.state());
    for (; !course_.every_step && course_.times.next() <= t(); course_.times.pass())
      course_.give_out(method_.state(), course_.times.next());
    begin_anew(singular_for);
    return true;
  }

  static constexpr double kForgotten = 0.8, kBeside = 2e-3;  // kBeside: rad
  static constexpr int kAsksForRows = 4;  // rejections: of redundant rows the kept ones may soon depend on one another
  static constexpr int kMostTakenBack = 12;

  Method& method_;
  const StepRule& rule_;
  Course& course_;
  const double end_, smallest_;
  StepController controller_;
  Creeping creeping_;
  double h_ = 0;
  double usual_ = 0;    // length of the steps so far, those long ago forgotten
  int rejections_ = 0;  // in a row
  double asked_at_ = -1;
  double no_sample_at_ = -1;  // an output time beside a singular position
  int taken_back_ = 0;        // steps for that
  bool cut_ = false;          // h is what laws leave of a step
};

// The method stands at the run's state.
template <class Method, class Leave>
Status controlled_run(Method& method, const StepRule& rule, const Run& run, PhaseClock& clock, const Leave& leave) {
  Course course(run, clock);
  clock.start();
  course.give_out(method.state());
  const Status status = ControlledSteps(method, rule, course).march(leave);
  finish(clock, run.statistics);
  run.state = method.state();
  return status;
}

}  // namespace poinsot
