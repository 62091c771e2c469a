// A body without moment of inertia about an axis on which all of its constraints act: nothing says how it spins.
//
// With inertia J̄ and J̄ w = 0, the rotation w turns no part of the body that has mass. A row holds it by the vectors of
// the body's frame it is made of, points s and directions a, which w × s and w × a vary: where all of these are along w
// no row does, wherever the mechanism stands, and the equations of motion do not determine ẇ along it.
#pragma once

#include <string>

#include "core/model.h"

namespace poinsot {

// The first such body, in words, with what to do; empty where there is none.
std::string open_spin(const Model& model);

// Unit axes of a body's frame about which it has no moment, in columns; others are zero.
Matrix3 axes_without_moment(const Body& body);
// w where `held` of the rotations about such axes, wᵀ held w, comes to no more than `least`, of unit length; else zero.
Vector3 unheld_axis(const Matrix3& without_moment, const Matrix3& held, double least);
// "body 'rod' has no moment of inertia about the axis (1, 0, 0) of its frame".
std::string describe_no_moment(const Body& body, const Vector3& axis);

}  // namespace poinsot
