// A pose that closes the mechanism, found from one that is far from it: every body moved as little as may be, weighed
// by its mass.
//
// With e what is open (integrators/start/closure.h; angles times the mechanism's size ℓ), J its derivative with the
// bodies' displacements and rotations δ, M their masses and moments, relative to the largest:
//
//   (JᵀJ + μ M) δ = −Jᵀe
//
// Levenberg and Marquardt's step. With μ → 0 it is the projection along M⁻¹Jᵀ, which moves bodies least; μ grows where
// a step does not close the mechanism further and shrinks where it does, and no step turns a body by more than a third
// of a radian, so that the pose stays on the branch it is nearest to. Rows that follow from others do no harm. Where
// the way leads to a pose that no small step closes further, it is tried once more from beside the given one.
//
// K. Levenberg 1944, D. Marquardt 1963; N. Yamashita, M. Fukushima, On the rate of convergence of the
// Levenberg-Marquardt method, 2001 (quadratic without full rank).
#pragma once

#include <span>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "integrators/start/closure.h"

namespace poinsot {

struct ClosedPose {
  bool closed = false;
  bool from_beside = false;       // it took a second try: what is found is one of several ways to close the mechanism
  std::vector<BodyState> states;  // where it is not closed: as near as it comes
  int worst = -1;                 // the group that stays open most, and by how much
  Gap gap = {};
};

// Larger mechanisms, long ones above all, are too soft to be closed to rounding by these steps.
inline constexpr std::size_t kMostClosed = 1000;  // bodies

ClosedPose close_mechanism(const Model& model, std::span<const BodyState> given);

}  // namespace poinsot
