// Where a joint sits in the frames of its bodies, however the scene says it: given there, or by a global point and axis
// at the initial pose.
//
// Complete frames have axes of unit length and, for every joint with axes, directions a_i and a_j of unit length
// perpendicular to them that coincide at angle 0 (core/scene.h says what that means for a universal joint). Where a
// scene names no such directions, the pose that it gives is that of angle 0.
#pragma once

#include <utility>
#include <vector>

#include "core/scene.h"

namespace poinsot {

// Two directions that make a right-handed orthonormal frame (a, b, axis).
std::pair<Vector3, Vector3> perpendiculars(const Vector3& axis);

// What is given of `a` across the unit vector `axis`, of unit length.
Vector3 across(const Vector3& axis, const Vector3& a);

// Of a joint of a valid scene with these bodies.
JointFrames complete_frames(const Joint& joint, const std::vector<Body>& bodies);

// Reference directions of an angle driver or a torsion spring: (a_i, b_i) across the axis in body i's frame, and a_j in
// body j's frame, which is at a_i at angle 0. Where none are given, `across_j` is taken if it is not zero: a direction
// of body j that stays across the axis; else any that is across it in the initial pose.
struct AngleFrame {
  Vector3 a_i, b_i, a_j;
};
template <class Item>  // Driver, TorsionSpring
AngleFrame angle_frame(const Item& item, const std::vector<Body>& bodies, const Vector3& across_j);

}  // namespace poinsot
