// Steppers as methods of a controlled run (controlled_run.h): what each makes of rejections and of the length it may
// have.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "integrators/stepping/explicit_stepper.h"
#include "integrators/stepping/radau_stepper.h"

namespace poinsot {

// Beside a singular position a step of the usual length may place a stage where its accelerations are lost to rounding;
// one not much shorter places it elsewhere.
inline constexpr double kShorter = 0.85;
// The first step out of one, in times after which velocities have led a thousandth of the bodies' sizes away.
inline constexpr double kWellBeside = 10;

// So many rejections in a row are more than error control needs to find a step: a singular position may be near, which
// a step of the usual length passes.
inline constexpr int kDifficult = 2;

inline double length_after(int rejections, double h, double usual, bool singular) {
  if (singular && rejections >= kDifficult) return std::max(h, usual * std::pow(kShorter, rejections - kDifficult));
  return rejections == kDifficult ? std::max(h, usual) : h;
}

class ControlledPair : public ExplicitStepper {
 public:
  using ExplicitStepper::ExplicitStepper;

  // A start where the trial step fails is left to the steps, which will tell why.
  double first_step(double end, double singular_for) {
    singular_ = at_start_ = singular_for > 0;
    if (singular_) return std::min(kWellBeside * singular_for, end);
    double h = 0;
    return ExplicitStepper::first_step(end, h).ok() ? h : 1e-6 * end;
  }
  Status attempt(double to, int rejections, double& error) {
    const Stages stages = rejections < kDifficult && !singular_ ? Stages::as_they_come : Stages::projected;
    probes_ = rejections == kDifficult && !singular_ && to - state().t > asked_;
    const Status status = ExplicitStepper::attempt(to, stages, error);
    failed_ = !status.ok();
    return status;
  }
  // A step longer than the error asks for is to pass a singular position. Where there is none, what its stages do not
  // see, as a stop that they were thrown back from, is not in its error either.
  Status complete(double& error, double most = 1) {
    constexpr double kTooLarge = 2;
    const Status status = examine(error, most);
    failed_ = !status.ok();
    if (failed_ || !(error <= most)) return status;
    passed_ = probes_ && comes_by_singular();
    if (probes_ && !passed_)
      error = kTooLarge * most;
    else
      keep();
    return {};
  }
  double retry(double h, int rejections, double usual) {
    singular_ = beside_singular() || at_start_;
    if (rejections == kDifficult) asked_ = failed_ ? HUGE_VAL : h;
    if (rejections > kDifficult && !singular_) return std::min(h, asked_);
    return length_after(rejections, h, usual, singular_);
  }
  bool by_singular() const { return singular_; }  // the last completed step came by a singular position
  double adopt(double, double wanted) {
    singular_ = beside_singular() || std::exchange(passed_, false);
    at_start_ = false;
    return wanted;
  }

 private:
  bool singular_ = false;                 // the last attempt came by a singular position
  bool at_start_ = false;                 // in one
  bool probes_ = false, passed_ = false;  // the last attempt looked for one, and came by it
  bool failed_ = false;                   // it had no error
  double asked_ = 0;                      // s, what the error asked for before it; infinite where there was none
};

// Of a run of radau5 that goes by the pair's steps there.
inline std::string passing_notice(const RungeKuttaPair& pair, double t) {
  return fmt::format(
      "beside a singular position, as before t = {:.6g} s, steps are those of {}, which pass it where those "
      "of radau5 do not",
      t, pair.name);
}

// Singular positions are passed by steps of an explicit pair: stages of radau5 leave the constraints, and an iteration
// has no limit beside them.
class ControlledRadau : public RadauStepper {
 public:
  ControlledRadau(Problem& problem, LinearSystems& systems, double rtol, double atol, Statistics& statistics,
                  PhaseClock& clock, const RungeKuttaPair& passing)
      : RadauStepper(problem, systems, rtol, atol, statistics, clock),
        make_passing_([=, &problem, &systems, &statistics, &clock, &passing] {
          return std::make_unique<ExplicitStepper>(passing, problem, systems, rtol, atol, statistics, clock);
        }) {}

  static constexpr StepRule kRule{0.9, 0.25, 0, 0.5, 8, true};

  Status attempt(double to, int rejections, double& error) {
    passes_ = false;
    if (!singular_ && !at_start_ && rejections < kDifficult) return RadauStepper::attempt(to, error);
    if (!passing_) {
      passing_ = make_passing_();
      if (Status status = passing_->prepare(); !status.ok()) return status;
    }
    if (Status status = passing_->start(state()); !status.ok()) return status;
    const Status status = passing_->attempt(to, ExplicitStepper::Stages::projected, error);
    passes_ = passing_->beside_singular() || at_start_;
    return passes_ ? status : RadauStepper::attempt(to, error);
  }
  Status complete(double& error, double most = 1) {
    if (!passes_) return RadauStepper::complete(error, most);
    if (Status status = passing_->complete(error, most); !status.ok() || !(error <= most)) return status;
    return RadauStepper::start(passing_->state());
  }
  const State& trial_end() { return passes_ ? passing_->trial_end() : RadauStepper::trial_end(); }
  bool passes() const { return passes_; }  // the last step was one of the pair
  Status interpolate(double t) { return passes_ ? passing_->interpolate(t) : RadauStepper::interpolate(t); }
  Status lead(double t) { return passes_ ? passing_->lead(t) : RadauStepper::lead(t); }
  const State& interpolated() const { return passes_ ? passing_->interpolated() : RadauStepper::interpolated(); }

  double first_step(double end, double singular_for) {
    at_start_ = singular_for > 0;
    return at_start_ ? std::min(kWellBeside * singular_for, end) : RadauStepper::first_step(end);
  }
  double retry(double h, int rejections, double usual) {
    singular_ = passes_ || RadauStepper::beside_singular();
    return length_after(rejections, h, usual, singular_);
  }
  double adopt(double h, double wanted) {
    at_start_ = false;
    singular_ = RadauStepper::beside_singular();
    return converges_fast() && wanted >= h && wanted <= kSameStep * h ? h : wanted;
  }

 private:
  static constexpr double kSameStep = 1.2;  // growth up to which a kept matrix saves more than a longer step does

  std::function<std::unique_ptr<ExplicitStepper>()> make_passing_;
  std::unique_ptr<ExplicitStepper> passing_;
  bool passes_ = false;    // the last attempt was the pair's
  bool singular_ = false;  // a singular position is near
  bool at_start_ = false;  // in one
};

}  // namespace poinsot
