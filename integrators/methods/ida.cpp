#include "integrators/methods/ida.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/check.h"
#include "core/interruption.h"
#include "integrators/methods/ida_objects.h"
#include "integrators/stepping/accept.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/observe.h"
#include "integrators/stepping/pulses.h"
#include "integrators/stepping/sample_times.h"
#include "integrators/stepping/stabilized_index2.h"
#include "integrators/stepping/step_control.h"
#include "integrators/stepping/switch_times.h"
#include "integrators/stepping/turning.h"
#include "integrators/stepping/vectors.h"
#include "linsolve/registry.h"

namespace poinsot {
namespace {

// IDA takes a hundred steps where a method of high order takes one, with errors of one sign: it is asked for a tenth of
// the tolerance, so that errors at the end of a run are comparable. Where that is below the rounding of the velocities
// its steps shrink to nothing; then it goes on with the tolerance itself.
constexpr double kShare = 0.1;
// Newton's corrections end below this part of the tolerance. IDA's own third makes more steps fail than it saves.
constexpr double kNewton = 0.1;

// IDA's objects and the run they are part of, which their callbacks are given.
class Session {
 public:
  explicit Session(const Run& run)
      : run_(run),
        problem_(run.problem),
        settings_(run.settings),
        statistics_(run.statistics),
        form_(std::in_place, problem_),
        system_(problem_, run.systems.add(Workload::solves), statistics_, clock_),
        consistent_(problem_, run.systems.add(), statistics_, clock_),
        sizes_(2 * static_cast<std::size_t>(problem_.nv())),
        sizes_now_(sizes_.size()),
        at_(run.state),
        next_(problem_),
        switches_(problem_.model(), run.settings.end, run.tell),
        pulses_(problem_.model(), run.settings.end, run.settings.rtol, run.tell),
        objects_(form_->size(), this, solve) {}

  Status prepare() {
    if (Status status = system_.prepare(form_->pattern(), form_->unknowns()); !status.ok()) return status;
    if (Status status = consistent_.prepare(); !status.ok()) return status;
    form_->start(at_, values(objects_.y.get()), values(objects_.y_dot.get()));
    void* ida = objects_.ida.get();
    const auto done = [](int flag) { check(flag == IDA_SUCCESS, "IDA accepts what it is given"); };
    done(IDAInit(ida, residual, 0, objects_.y.get(), objects_.y_dot.get()));
    done(IDASetErrHandlerFn(ida, keep_silent, nullptr));
    done(IDASetUserData(ida, this));
    done(IDAWFtolerances(ida, weights));
    done(IDASetLinearSolver(ida, objects_.linear.get(), objects_.matrix.get()));
    done(IDASetJacFn(ida, jacobian));
    done(IDASetNonlinConvCoef(ida, kNewton));
    done(IDASetStopTime(ida, settings_.end));
    return {};
  }

  Status integrate() {
    clock_.start();
    consistent_.stand(at_);
    limit_turn();
    give_out();
    const Status status = advance();
    count();
    finish(clock_, statistics_);
    run_.state = at_;
    return status;
  }

 private:
  Status advance() {
    SampleTimes times(settings_.every, settings_.end);
    Creeping creeping(settings_.end);
    double t = 0;
    while (t < settings_.end) {
      if (interruption_requested) return interrupted(t);
      const SwitchTimes::Switch turn = next_switch(t, creeping);
      if (turn.before <= t) {
        if (Status status = cross(std::min(turn.after, settings_.end)); !status.ok()) return status;
        t = at_.t;
        if (settings_.every > 0 && times.next() > t) continue;
        consistent_.stand(at_);
        give_out(settings_.every > 0 ? times.next() : t);
        times.pass();
        continue;
      }
      if (IDASolve(objects_.ida.get(), settings_.end, &t, objects_.y.get(), objects_.y_dot.get(), IDA_ONE_STEP) < 0) {
        if (Status status = go_on(); !status.ok()) return status;
        continue;
      }
      ++statistics_.steps;
      double h = 0;
      IDAGetLastStep(objects_.ida.get(), &h);
      statistics_.largest_rotation = std::max(statistics_.largest_rotation, h * problem_.fastest_turn());
      limit_turn();
      if (creeping.tries(t, h)) return step_too_small(t, h, {});
      creeping.completed(h);
      for (; settings_.every > 0 && times.next() < t; times.pass()) {
        if (Status status = stand_at(times.next()); !status.ok()) return status;
        give_out();
      }
      if (t == turn.before) {  // given out beyond the switch
        if (Status status = stand_at(t); !status.ok()) return status;
        continue;
      }
      if (settings_.every == 0 || times.next() == t) {
        times.pass();
        if (Status status = stand_at(t); !status.ok()) return status;
        give_out();
      }
      if (!problem_.has_discrete_state() || t >= settings_.end) continue;
      if (Status status = accept(t); !status.ok()) return status;
    }
    return {};
  }

  // The next step by how fast counted angles turn now, with room for their getting faster.
  void limit_turn() {
    const double rate = problem_.counted_turn().rate;
    if (rate > 0) IDASetMaxStep(objects_.ida.get(), 0.5 * kMostCounted / rate);
  }

  // The next switch of the data within reach of IDA's next step, which it then does not step over, nor a pulse.
  SwitchTimes::Switch next_switch(double t, Creeping& creeping) {
    double h = 0;
    IDAGetCurrentStep(objects_.ida.get(), &h);
    const double reach = h > 0 ? 2 * h : 0.01 * (settings_.end - t);  // its first step is a tenth of that, or less
    const double ahead = std::min(t + reach, settings_.end);
    const SwitchTimes::Switch turn = switches_.first(t, ahead);
    if (turn.before > t) {
      // It looks at forces once a step, one-step methods at so many stages.
      constexpr double kStages = 8;
      const double wanted = std::min({turn.before, t + kStages * reach, settings_.end});
      const double seen = pulses_.reach(t, wanted);
      if (seen < wanted) creeping.limited();
      const double stop = seen < wanted ? t + (seen - t) / kStages : std::min(turn.before, settings_.end);
      check(IDASetStopTime(objects_.ida.get(), stop) == IDA_SUCCESS, "IDA stops at a switch");
    }
    return turn;
  }

  // at_ stands at a switch.
  Status cross(double t) {
    at_.t = t;
    if (Status status = consistent_.cross(at_); !status.ok()) return status;
    bool rewritten = false;
    if (Status status = poinsot::accept(problem_, at_, rewritten); !status.ok()) return status;
    if (rewritten) {
      if (Status status = prepare_form(); !status.ok()) return status;
    }
    start_anew(t);
    return {};
  }

  // After a failure of IDA: again from the last point, at the tolerance itself.
  Status go_on() {
    double t = 0, h = 0;
    IDAGetCurrentTime(objects_.ida.get(), &t);
    IDAGetCurrentStep(objects_.ida.get(), &h);
    if (t > at_.t) {
      if (Status status = stand_at(t); !status.ok()) return status;
    }
    if (share_ == 1) return step_too_small(t, h, linear_status_);
    share_ = 1;
    start_anew(t);
    return {};
  }

  void count() {
    long newton = 0, error_tests = 0, failures = 0;
    IDAGetNumNonlinSolvIters(objects_.ida.get(), &newton);
    IDAGetNumErrTestFails(objects_.ida.get(), &error_tests);
    IDAGetNumStepSolveFails(objects_.ida.get(), &failures);
    statistics_.newton_iterations += newton;
    statistics_.rejected_steps += error_tests + failures;
  }

  // Makes the motion at a time within the last step the state.
  Status stand_at(double t) {
    check(IDAGetDky(objects_.ida.get(), t, 0, objects_.inner.get()) == IDA_SUCCESS,
          "the time lies within IDA's last step");
    const std::span<const double> y = values(objects_.inner.get());
    next_.t = t;
    std::ranges::copy(form_->q(y), next_.q.begin());
    std::ranges::copy(form_->v(y), next_.v.begin());
    if (Status status = consistent_.complete(next_); !status.ok()) return status;
    if (consistent_.leaves_branch(next_)) {
      return {
          Failure::singular_position, t,
          fmt::format("at t = {:.9g} s, beside a singular position of the constraints, the velocities jump: rounding "
                      "would choose which way the mechanism goes on; dop853 or an implicit integrator with a fixed "
                      "step may pass",
                      t)};
    }
    consistent_.follow(next_);
    std::swap(at_, next_);
    return {};
  }

  // Turns of torsion springs, the choice among redundant rows; no formulation IDA is used with rewrites its
  // coordinates.
  Status accept(double t) {
    if (Status status = stand_at(t); !status.ok()) return status;
    bool rewritten = false;
    if (Status status = poinsot::accept(problem_, at_, rewritten); !status.ok() || !rewritten) return status;
    if (Status status = prepare_form(); !status.ok()) return status;
    start_anew(t);
    return {};
  }
  Status prepare_form() {
    form_.emplace(problem_);
    return system_.prepare(form_->pattern(), form_->unknowns());
  }

  // From the last point: what IDA remembers of the motion is gone.
  void start_anew(double t) {
    count();
    form_->start(at_, values(objects_.y.get()), values(objects_.y_dot.get()));
    check(IDAReInit(objects_.ida.get(), t, objects_.y.get(), objects_.y_dot.get()) == IDA_SUCCESS, "IDA starts anew");
  }

  void give_out() { give_out(at_.t); }
  void give_out(double t) {
    clock_.pause();
    sample(run_.observe, problem_, at_, statistics_, t);
    clock_.resume();
  }

  // IDA's callbacks: 0 done, 1 not possible here, try a smaller step.
  static Session& of(void* user) { return *static_cast<Session*>(user); }
  static std::span<double> values(N_Vector x) { return IdaObjects::values(x); }
  static int residual(double t, N_Vector y, N_Vector y_dot, N_Vector F, void* user) {
    const std::span<double> out = values(F);
    of(user).form_->residual(t, values(y), values(y_dot), out);
    return std::ranges::all_of(out, [](double x) { return std::isfinite(x); }) ? 0 : 1;
  }
  static int jacobian(double t, double alpha, N_Vector y, N_Vector y_dot, N_Vector, SUNMatrix, void* user, N_Vector,
                      N_Vector, N_Vector) {
    Session& session = of(user);
    session.linear_status_ = session.system_.refresh(t, [&](std::span<const int> slots, std::span<double> matrix) {
      session.form_->assemble(t, alpha, values(y), values(y_dot), slots, matrix);
    });
    return session.linear_status_.ok() ? 0 : 1;
  }
  static int solve(SUNLinearSolver shell, SUNMatrix, N_Vector x, N_Vector b, double) {
    Session& session = of(shell->content);
    std::ranges::copy(values(b), values(x).begin());
    double t = 0;
    IDAGetCurrentTime(session.objects_.ida.get(), &t);
    session.linear_status_ = session.system_.solve(t, values(x));
    return session.linear_status_.ok() ? 0 : 1;
  }
  // IDA's norm is sqrt(Σ (w y)²/n) over all unknowns; ours is over positions and velocities. Sizes are the largest so
  // far: a tolerance that shrinks wherever a body pauses throws a multistep method back to small steps of order 1.
  static int weights(N_Vector y, N_Vector w, void* user) {
    Session& session = of(user);
    const std::span<double> out = values(w);
    component_sizes(session.problem_, session.form_->q(values(y)), session.form_->v(values(y)), session.sizes_now_);
    const double mean = std::sqrt(static_cast<double>(out.size()) / static_cast<double>(session.sizes_.size()));
    std::ranges::fill(out, 0.0);
    for (std::size_t k = 0; k < session.sizes_.size(); ++k) {
      session.sizes_[k] = std::max(session.sizes_[k], session.sizes_now_[k]);
      out[k] = mean /
               (session.share_ * (session.settings_.absolute_tolerance() + session.settings_.rtol * session.sizes_[k]));
    }
    return 0;
  }
  static void keep_silent(int, const char*, const char*, char*, void*) {}

  const Run& run_;
  Problem& problem_;
  const Settings& settings_;
  Statistics& statistics_;
  PhaseClock clock_;
  std::optional<StabilizedIndex2> form_;  // anew for other rows
  TimedSystem system_;
  Consistent consistent_;
  std::vector<double> sizes_, sizes_now_;
  State at_, next_;  // the last point given out, and the next one while it is made
  SwitchTimes switches_;
  Pulses pulses_;
  Status linear_status_;
  double share_ = kShare;  // of the tolerance
  IdaObjects objects_;
};

class Ida final : public Integrator {
 public:
  Status run(const Run& run) override {
    Session session(run);
    if (Status status = session.prepare(); !status.ok()) return status;
    return session.integrate();
  }
};

}  // namespace

std::unique_ptr<Integrator> make_ida() {
  return std::make_unique<Ida>();
}

}  // namespace poinsot
