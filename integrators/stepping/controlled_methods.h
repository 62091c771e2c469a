// Steppers as methods of a controlled run (controlled_run.h): what each makes of rejections and of the length it may
// have.
#pragma once

#include <algorithm>
#include <cmath>

#include "integrators/stepping/explicit_stepper.h"
#include "integrators/stepping/radau_stepper.h"

namespace poinsot {

// Beside a singular position a step of the usual length may place a stage where its accelerations are lost to rounding;
// one not much shorter places it elsewhere.
inline constexpr double kShorter = 0.85;
// The first step out of one, in times after which velocities have led a thousandth of the bodies' sizes away.
inline constexpr double kWellBeside = 10;

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
    return ExplicitStepper::attempt(to, stages, error);
  }
  double retry(double h, int rejections, double usual) {
    singular_ = beside_singular() || at_start_;
    if (singular_ && rejections >= kDifficult) return std::max(h, usual * std::pow(kShorter, rejections - kDifficult));
    return rejections == kDifficult ? std::max(h, usual) : h;
  }
  double adopt(double, double wanted) {
    singular_ = beside_singular();
    at_start_ = false;
    return wanted;
  }

 private:
  // So many rejections in a row are more than error control needs to find a step: a singular position may be near,
  // which a step of the usual length passes.
  static constexpr int kDifficult = 2;
  bool singular_ = false;  // the last attempt came by a singular position
  bool at_start_ = false;  // in one
};

class ControlledRadau : public RadauStepper {
 public:
  using RadauStepper::RadauStepper;

  static constexpr StepRule kRule{0.9, 0.25, 0, 0.5, 8, true};

  Status attempt(double to, int, double& error) { return RadauStepper::attempt(to, error); }
  double first_step(double end, double singular_for) {
    at_start_ = singular_for > 0;
    return at_start_ ? std::min(kWellBeside * singular_for, end) : RadauStepper::first_step(end);
  }
  double retry(double h, int rejections, double usual) {
    return beside_singular() || at_start_ ? std::max(h, usual * std::pow(kShorter, rejections)) : h;
  }
  double adopt(double h, double wanted) {
    (void)beside_singular();
    at_start_ = false;
    return converges_fast() && wanted >= h && wanted <= kSameStep * h ? h : wanted;
  }

 private:
  static constexpr double kSameStep = 1.2;  // growth up to which a kept matrix saves more than a longer step does
  bool at_start_ = false;                   // in a singular position
};

}  // namespace poinsot
