// The cheapest way to an accuracy on one scene, found by running: every integrator in every formulation, with the
// coarsest step or tolerance at which its error against the reference is small enough.
//
// Error-controlled integrators begin at rtol = accuracy and go by half decades; those of fixed step begin at 100 steps
// and are extrapolated by their order. A method that would take many times as long as the best one so far is not
// followed further. The linear solver is chosen last, for the method found.
#pragma once

#include <vector>

#include "bench/study/sweep.h"

namespace poinsot::study {

struct Asked {
  double accuracy = 1e-6;
  std::vector<std::size_t> quantities;  // that must reach it, by their number in kQuantities
};

struct Candidate {
  Case one;
  Measured measured;
};

struct Calibration {
  std::vector<Candidate> reaching;  // the cheapest case of each method that reaches it; the cheapest of all first
  std::vector<Candidate> others;    // the most accurate case of each method that does not; the most accurate first
};

Calibration calibrate(const Sweep& sweep, const Reference& reference, const Asked& asked, bool kinematics);

// The largest error of the quantities asked for, no smaller than the reference resolves; infinite for a failure and for
// what there is none of.
double error(const Measured& measured, const Reference& reference, const Asked& asked);

}  // namespace poinsot::study
