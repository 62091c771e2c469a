// Steppers as methods of a controlled run (controlled_run.h): what each makes of rejections and of the length it may
// have.
#pragma once

#include <algorithm>

#include "integrators/stepping/explicit_stepper.h"
#include "integrators/stepping/radau_stepper.h"

namespace poinsot {

class ControlledPair : public ExplicitStepper {
 public:
  using ExplicitStepper::ExplicitStepper;

  // A start where the trial step fails is left to the steps, which will tell why.
  double first_step(double end) {
    double h = 0;
    return ExplicitStepper::first_step(end, h).ok() ? h : 1e-6 * end;
  }
  Status attempt(double to, int rejections, double& error) {
    return ExplicitStepper::attempt(to, rejections < kDifficult ? Stages::as_they_come : Stages::projected, error);
  }
  double retry(double h, int rejections, double usual) const {
    return rejections == kDifficult ? std::max(h, usual) : h;
  }
  double adopt(double, double wanted) const { return wanted; }

 private:
  // So many rejections in a row are more than error control needs to find a step: a singular position may be near,
  // which a step of the usual length passes.
  static constexpr int kDifficult = 2;
};

class ControlledRadau : public RadauStepper {
 public:
  using RadauStepper::RadauStepper;

  static constexpr StepRule kRule{0.9, 0.25, 0, 0.5, 8, true};

  Status attempt(double to, int, double& error) { return RadauStepper::attempt(to, error); }
  double retry(double h, int, double) const { return h; }
  double adopt(double h, double wanted) const {
    return converges_fast() && wanted >= h && wanted <= kSameStep * h ? h : wanted;
  }

 private:
  static constexpr double kSameStep = 1.2;  // growth up to which a kept matrix saves more than a longer step does
};

}  // namespace poinsot
