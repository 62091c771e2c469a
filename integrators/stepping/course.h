// What lies before a run under error control, whichever method is at it: the clock, output times, kinks and jumps of
// the data, what laws of springs do on the way, who is given what, and when to say that it comes to no end.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrators/stepping/consistent.h"
#include "integrators/stepping/driver_impulses.h"
#include "integrators/stepping/driver_jumps.h"
#include "integrators/stepping/energy_balance.h"
#include "integrators/stepping/law_switches.h"
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
#include "integrators/stepping/table_knots.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

inline void tell_long_way(const Run& run, double t, double steps) {
  run.tell(
      fmt::format("up to t = {:.6g} s {} steps were done, and as it goes on the end is some {:.0e} further ones away",
                  t, run.statistics.steps, steps));
}

class Course {
 public:
  Course(const Run& run, PhaseClock& clock)
      : every_step(run.settings.every == 0),
        times(run.settings.every, run.settings.end),
        switches(run.problem.model(), run.settings.end, run.tell),
        pulses(run.problem.model(), run.settings.end, run.settings.rtol, run.tell),
        knots(run.problem.model(), run.settings.end, run.settings.rtol),
        driver_jumps(run.problem.model(), run.settings.end),
        driver_impulses(run),
        laws(run.problem.model()),
        passed_laws(laws, run.settings.end, run.settings.rtol, run.settings.absolute_tolerance(), run.tell),
        law_switches(laws, run.settings.end, run.settings.rtol, run.settings.absolute_tolerance()),
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
  // Steps from t have become as short as h, the last one tried went to `to`.
  Status too_small(double t, double to, double h, const Status& cause) {
    if (Status status = driver_jumps.look(to); !status.ok()) return status;
    return step_too_small(t, h, cause);
  }
  // A step ended at `at`, where the problem stands.
  Status follow(const State& at) {
    if (Status status = driver_jumps.look(at.t); !status.ok()) return status;
    still_.look(run_.problem, at);
    if (run_.energy && run_.energy->due()) run_.energy->look(run_.problem, at.t, at.v);
    if (progress_.look(at.t)) {
      if (progress_.never_ends()) return never_beyond(run_.problem, at, progress_.limit());
      if (progress_.takes_long_for_a_rest())
        if (Status status = sticking_.look_for_rest(run_.problem, at); !status.ok()) return status;
      if (progress_.takes_long() && !std::exchange(long_told_, true)) tell_long_way(run_, at.t, progress_.steps_left());
    }
    return sticking_.look(run_.problem, at);
  }
  void begin_laws(const State& from) {
    laws.begin(run_.problem, from);
    law_switches.begin();
  }
  // The method stands beyond a switch.
  void begin_anew(const State& from) {
    begin_laws(from);
    progress_.begins_anew();
  }
  // How far a step from t towards `to` may go for what is known before it of the data.
  double aim(double t, double to) {
    const double seen = knots.reach(t, pulses.reach(t, to));
    return laws.none() || !(t < seen) ? seen : passed_laws.to_knot(seen);
  }
  // How far a step to `to`, where the problem stands, may go for what laws of springs do on its way.
  double seen(const State& to) {
    if (laws.none()) return to.t;
    laws.look(run_.problem, to);
    const double seen = passed_laws.reach();
    return std::min(seen, law_switches.reach(to.t));
  }
  // How far a step to a time may go that failed, as by a law that it goes over; infinite where that is not the cause.
  template <class Method>
  double switched(const Status& status, double error, double to, Method& method) {
    constexpr double kAboutRight = 1e-3;
    constexpr int kMostInARow = 4;
    if (laws.none() || switched_ == kMostInARow) return HUGE_VAL;
    if (status.ok() && error * run_.settings.rtol < kAboutRight) laws.look(run_.problem, method.trial_end());
    const double seen = law_switches.reach(to);
    switched_ = seen < to ? switched_ + 1 : 0;
    return seen < to ? seen : HUGE_VAL;
  }
  void accept_laws() {
    switched_ = 0;
    law_switches.accept();
    laws.accept();
  }
  void take_back_laws() {
    laws.take_back();
    law_switches.begin();
  }
  double turned(double h) const { return h * run_.problem.fastest_turn(); }  // rad, the fastest body at its speed now
  const Problem& problem() const { return run_.problem; }
  double end() const { return run_.settings.end; }
  // See Run::singular_for; 0 once the run is under way.
  double singular_for(double t) const { return t > 0 ? 0 : run_.singular_for; }
  Statistics& statistics() { return run_.statistics; }
  std::int64_t most_rejected() const { return run_.most_rejected; }

  const bool every_step;
  SampleTimes times;
  SwitchTimes switches;
  Pulses pulses;
  TableKnots knots;
  DriverJumps driver_jumps;
  DriverImpulses driver_impulses;
  LawSteps laws;
  PassedLaws passed_laws;
  LawSwitches law_switches;

 private:
  const Run& run_;
  PhaseClock& clock_;
  StillWatch still_;
  Progress progress_;
  bool long_told_ = false;
  int switched_ = 0;  // in a row
  StickingWatch sticking_;
  OpenMultipliers open_multipliers_;
};

}  // namespace poinsot
