#include "integrators/methods/ida.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/interruption.h"
#include "integrators/methods/dop853.h"
#include "integrators/methods/ida_marks.h"
#include "integrators/methods/ida_system.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/controlled_methods.h"
#include "integrators/stepping/controlled_run.h"
#include "integrators/stepping/narrow_gap.h"
#include "integrators/stepping/turning.h"

namespace poinsot {
namespace {

constexpr int kPasses = 4;        // one soon after the other that see no singular position: then none is the cause
constexpr double kNear = 0.5;     // rad: so soon after one failure another has the same cause
constexpr double kOnward = 1e-4;  // and so little of the run later
constexpr double kStands = 0.5;   // rad: so far on the motion is made the state, whoever asks for it

class Session {
 public:
  explicit Session(const Run& run)
      : run_(run),
        problem_(run.problem),
        settings_(run.settings),
        statistics_(run.statistics),
        ida_(run, clock_),
        consistent_(problem_, run.systems.add(), statistics_, clock_),
        passage_(problem_, consistent_),
        gap_(problem_, consistent_),
        marks_(problem_, consistent_),
        at_(run.state),
        next_(problem_),
        course_(run, clock_) {}

  Status integrate() {
    if (Status status = ida_.begin(at_); !status.ok()) return status;
    if (Status status = consistent_.prepare(); !status.ok()) return status;
    clock_.start();
    consistent_.stand(at_);
    if (run_.singular_for == 0 && consistent_.factor(at_.t).ok()) consistent_.follow(at_);
    marks_.begin(at_);
    ida_.turn_at_most(problem_.counted_turn().rate);
    course_.give_out(at_);
    Status status = run_.singular_for > 0 ? pass() : Status{};
    if (status.ok()) status = advance();
    ida_.count(statistics_);
    finish(clock_, statistics_);
    run_.state = at_;
    return status;
  }

 private:
  Status advance() {
    Creeping creeping(settings_.end);
    SampleTimes& times = course_.times;
    while (at_t_ < settings_.end) {
      if (interruption_requested) return interrupted(at_t_);
      const SwitchTimes::Switch turn = next_switch(creeping);
      if (turn.before <= at_t_) {
        if (Status status = cross(std::min(turn.after, settings_.end)); !status.ok()) return status;
        if (!course_.every_step && times.next() > at_t_) continue;
        consistent_.stand(at_);
        course_.give_out(at_, course_.every_step ? at_t_ : times.next());
        times.pass();
        continue;
      }
      if (!ida_.step(at_t_)) {
        if (Status status = go_on(); !status.ok()) return status;
        continue;
      }
      ++statistics_.steps;
      const double h = ida_.last_step(), t = at_t_;
      statistics_.largest_rotation = std::max(statistics_.largest_rotation, course_.turned(h));
      since_pass_ += course_.turned(h), since_stood_ += course_.turned(h);
      ida_.read_end(t, next_);
      if (Status status = course_.follow(next_); !status.ok()) {
        (void)stand_at(t);  // for what is said of it
        return status;
      }
      if (Status status = marks_.pass(next_, course_.turned(h)); !status.ok()) return status;
      const double rate = problem_.counted_turn().rate;
      ida_.turn_at_most(rate);
      // That limit holds for steps that grow alone.
      const bool may_jump = h * std::max(rate, std::exchange(counted_, rate)) >= kMostCounted;
      if (may_jump) {
        if (Status status = pass(); !status.ok()) return status;
        continue;
      }
      Status status;
      for (; !course_.every_step && times.next() < t; times.pass()) {
        if (interruption_requested) return interrupted(times.next());
        if (status = stand_at(times.next()); !status.ok()) break;
        course_.give_out(at_);
      }
      if (status.ok() && creeping.tries(t, h)) {
        if (status = go_on(); !status.ok()) return status;
        creeping = Creeping(settings_.end);
        continue;
      }
      creeping.completed(h);
      const bool crosses = t == turn.before && t < settings_.end;  // given out beyond the switch
      const bool given = !crosses && (course_.every_step || times.next() == t);
      if (status.ok() && (crosses || given || since_stood_ > kStands)) status = stand_at(t);
      if (status.ok() && given) {
        times.pass();
        course_.give_out(at_);
      }
      if (status.ok() && !crosses && t < settings_.end) status = keep_up(t);
      if (!status.ok()) {
        if (status = detour(status); !status.ok()) return status;
      }
    }
    return {};
  }

  // What is discrete follows the motion as IDA has it, off the constraints by its tolerance. Where that seems to be off
  // rows that are set aside, a state on the constraints decides.
  Status keep_up(double t) {
    if (!problem_.has_discrete_state() && !problem_.exchanges_rows()) return {};
    ida_.read_end(t, next_);
    problem_.set_position(t, span(next_.q));
    problem_.set_velocity(span(next_.v));
    bool other_rows = false;  // no formulation IDA is used with rewrites its coordinates
    Status status = poinsot::accept(problem_, next_, other_rows);
    if (!status.ok()) {
      if (status = stand_at(t); !status.ok()) return status;
      if (status = poinsot::accept(problem_, at_, other_rows); !status.ok()) return status;
    }
    return other_rows ? ida_.renew() : Status{};
  }

  // The next switch of the data within reach of IDA's next step, which it then does not step over, nor a pulse.
  SwitchTimes::Switch next_switch(Creeping& creeping) {
    const double t = at_t_, h = ida_.next_step();
    const double reach = h > 0 ? 2 * h : 0.01 * (settings_.end - t);  // its first step is a tenth of that, or less
    const double ahead = std::min(t + reach, settings_.end);
    const SwitchTimes::Switch turn = course_.switches.first(t, ahead);
    if (turn.before > t) {
      // It looks at forces once a step, one-step methods at so many stages.
      constexpr double kStages = 8;
      const double wanted = std::min({turn.before, t + kStages * reach, settings_.end});
      const double seen = course_.pulses.reach(t, wanted);
      if (seen < wanted) creeping.limited();
      // So its first step is not to end at the next switch, where a force may be what it is here.
      const bool sees_ends_alone = seen < wanted || (h == 0 && wanted == turn.before);
      ida_.stop_at(
          seen_by_laws(sees_ends_alone ? t + (seen - t) / kStages : std::min(turn.before, settings_.end), ahead));
    }
    return turn;
  }

  // A step is not offered back, so that what laws do within it is looked for before it, as the motion goes on now.
  double seen_by_laws(double stop, double ahead) {
    if (course_.passed_laws.none() || !(ahead > at_t_)) return stop;
    ida_.read_end(at_t_, next_);
    problem_.set_position(at_t_, span(next_.q));
    problem_.set_velocity(span(next_.v));
    course_.laws.begin(problem_, next_);
    const double seen = course_.passed_laws.ahead(ahead);
    return seen < ahead ? std::min(seen, stop) : stop;
  }

  // at_ stands at a switch.
  Status cross(double t) {
    if (Status status = course_.driver_jumps.look(t); !status.ok()) return status;
    course_.driver_impulses.expect(at_, t);
    if (Status status = consistent_.cross(at_, t); !status.ok()) return status;
    course_.driver_impulses.look(at_);
    marks_.forget();
    bool other_rows = false;
    if (Status status = poinsot::accept(problem_, at_, other_rows); !status.ok()) return status;
    if (other_rows) return renew();
    begin_again();
    return {};
  }

  // After a failure of IDA: over a singular position, as may be near, or where none was seen, again at the tolerance
  // itself.
  Status go_on() {
    const double t = ida_.time(), h = ida_.next_step();
    if (t > at_.t) {
      if (Status status = stand_at(t); !status.ok()) return detour(status);
    }
    const bool far = since_pass_ > kNear && at_.t > failed_at_ + kOnward * settings_.end;
    failed_at_ = at_.t;
    if (by_singular_ || far) passes_ = 0;
    if (++passes_ <= kPasses) return pass();
    if (ida_.relax()) return step_too_small(at_.t, h, ida_.linear_status());
    begin_again();
    return {};
  }

  // Where no state can be made of IDA's motion, which is off the constraints or, beside a singular position, not on the
  // branch any more: over that place from the last point.
  Status detour(const Status& why) {
    const bool lost = why.failure == Failure::singular_position || why.failure == Failure::inconsistent_state;
    return lost ? pass() : why;
  }

  // A longer step would go over a place where the angle of a torsion spring jumps by half a turn.
  bool has_lost_an_angle() {
    constexpr double kNothing = 1e-3;  // of its direction, across its axis
    consistent_.stand(at_);
    const CountedTurn turn = problem_.counted_turn();
    return turn.rate > 0 && turn.across < kNothing;
  }

  // By steps of an explicit pair from at_ until well beyond singular positions.
  Status pass() {
    constexpr int kSteps = 30;  // in which one is seen
    constexpr double kFar = 0.1;
    if (has_lost_an_angle()) return step_too_small(at_.t, ida_.last_step(), {Failure::rotation_too_large, at_.t, {}});
    if (!passing_) {
      passing_.emplace(dop853_pair(), problem_, run_.systems, settings_.rtol, settings_.absolute_tolerance(),
                       statistics_, clock_);
      if (Status status = passing_->prepare(); !status.ok()) return status;
    }
    if (Status status = passing_->start(at_); !status.ok()) return status;
    marks_.expect(*passing_, at_.t);
    const double from = at_.t;
    by_singular_ = false;
    int steps = 0;
    since_pass_ = 0;
    const Status status = ControlledSteps(*passing_, dop853_pair().rule, course_).march([&] {
      by_singular_ = by_singular_ || passing_->by_singular();
      since_pass_ = passing_->by_singular() ? 0 : since_pass_ + course_.turned(passing_->last_step());
      return since_pass_ > kFar || (!by_singular_ && ++steps == kSteps << passes_);
    });
    at_ = passing_->state();
    gap_.forget();
    if (!std::exchange(told_, true)) tell_passage(from);
    if (!status.ok()) return status;
    return renew();
  }

  // Whether a singular position was in the way the steps over the place have seen.
  void tell_passage(double from) {
    run_.tell(fmt::format("at t = {:.6g} s{} steps of ida come to nothing: those of {} lead on from such places", from,
                          by_singular_ ? ", as beside a singular position," : "", dop853_pair().name));
  }

  // Makes the motion at a time within the last step the state.
  Status stand_at(double t) {
    ida_.read(t, next_);
    if (Status status = passage_.complete(next_); !status.ok()) return status;
    if (consistent_.leaves_branch(next_) || gap_.goes_over(at_, next_, passage_.settled()))
      return {Failure::singular_position, t, {}};
    consistent_.follow(next_);
    gap_.follow(next_, passage_.settled());
    since_stood_ = 0;
    std::swap(at_, next_);
    return {};
  }

  // From the last point with the rows that the problem has now.
  Status renew() {
    if (Status status = ida_.renew(); !status.ok()) return status;
    begin_again();
    return {};
  }

  // From the last point: what IDA remembers of the motion is gone.
  void begin_again() {
    ida_.count(statistics_);
    ida_.begin_again(at_);
    counted_ = 0;
    at_t_ = at_.t;
    marks_.go_back_to(at_.t);
  }

  const Run& run_;
  Problem& problem_;
  const Settings& settings_;
  Statistics& statistics_;
  PhaseClock clock_;
  IdaSystem ida_;
  Consistent consistent_;
  Passage passage_;
  NarrowGap gap_;
  IdaMarks marks_;
  State at_, next_;     // the last point given out, and the next one while it is made
  double at_t_ = 0;     // IDA's time
  double counted_ = 0;  // rad/s, of the fastest counted angle where IDA's last step ended
  Course course_;
  std::optional<ControlledPair> passing_;
  double failed_at_ = -HUGE_VAL;
  int passes_ = 0;  // that saw no singular position, one soon after the other
  bool told_ = false;
  bool by_singular_ = false;      // the last pass came by one
  double since_pass_ = HUGE_VAL;  // rad
  double since_stood_ = 0;        // rad
};

class Ida final : public Integrator {
 public:
  Status run(const Run& run) override { return Session(run).integrate(); }
};

}  // namespace

std::unique_ptr<Integrator> make_ida() {
  return std::make_unique<Ida>();
}

}  // namespace poinsot
