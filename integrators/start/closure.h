// How far a pose leaves each constraint, joint and driver open at t = 0, in metres and radians, and how that varies.
//
// Rows are dot products and cannot tell a direction from its opposite: an axis the wrong way round satisfies them. What
// is measured here can, and grows all the way to half a turn:
//
//   points       the components of d, or its parts across an axis; |d| − length
//   one axis     θ n, the angle between axes u of i and v of j and the direction n = u × v/|u × v| they turn about
//   orientation  the rotation vector of F_iᵀF_j, F = [a, axis × a, axis] of fixed and translational joints
//   angle        of a driver, less f(0), between −π and π
//   else         DP1 and DP2 of unit directions
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"

namespace poinsot {

// One number that is zero where the mechanism is closed. Its derivative: g with r_j, −g with r_i, and with the bodies'
// rotations φ in global components (δu = φ × u) on_i and on_j.
struct OpenPart {
  int group;
  bool angle;  // rad; else m
  double value;
  Vector3 g, on_i, on_j;
};

// By group of the model; velocity constraints have none.
std::vector<OpenPart> open_parts(const Model& model, std::span<const BodyState> states);

struct Gap {
  double metres = 0, radians = 0;

  double largest() const { return std::max(metres, radians); }
};
// "0.242 m", "0.242 m and 0.1 rad"; "moved by 0.242 m and turned by 0.1 rad" with the words for it.
std::string describe(const Gap& gap, std::string_view moved = "", std::string_view turned = "");

// Of every group.
std::vector<Gap> gaps(const Model& model, std::span<const BodyState> states);

}  // namespace poinsot
