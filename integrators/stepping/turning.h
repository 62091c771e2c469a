// How far bodies turn in a step: what is measured, and what a step may not exceed.
//
// The angle of a torsion spring, a driven angle and, where signals are asked for, that of a joint are told by positions
// up to full or half turns only; a step that turns one by kMostCounted or more could miscount (a limit below π, because
// the rate varies within the step). Methods with error control make their steps shorter, those with fixed steps stop.
#pragma once

#include "formulations/problem.h"

namespace poinsot {

inline constexpr double kMostCounted = 3;  // rad
// In a step of fixed length a body may turn by so much more or less than in the step before it, rad. Beyond, what
// Newton's method has found may be another way to put the mechanism together, or a turn too many.
inline constexpr double kMostUnexpected = 1;

inline bool turns_too_far(const Problem& problem, double h) {
  return h * problem.counted_turn().rate >= kMostCounted;
}

// Where the fastest counted angle is all but undefined, why; else empty. Needs the velocity.
std::string undefined_angle(const Problem& problem);

// The stop of a fixed step, or of one that cannot be shorter. The problem stands at its end.
Status turned_too_far(const Problem& problem, double t, double h);
// The same for a body whose rotation in a step exceeds `most`, for a reason named by the integrator's registry.
// `began`: rad in a step at the start of the run; `serves`: the step to try, s.
Status rotated_too_far(const Problem& problem, std::span<const double> a, double t, double h, double most, double began,
                       double serves);
Status turned_unexpectedly(const Problem& problem, std::span<const double> a, double t, double h, double unexpected,
                           double serves);
// The same of kinematics, whose steps are followed in parts. The problem stands where `parts` of them have led to.
Status leads_too_far(const Problem& problem, std::span<const double> a, double t, int parts, double serves);

}  // namespace poinsot
