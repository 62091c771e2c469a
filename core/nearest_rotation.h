// Orientations given to a few digits: how far a matrix is from a rotation, and the rotation nearest to it.
#pragma once

#include <Eigen/Core>

namespace poinsot {

// A matrix is taken for a rotation where the nearest one differs from it by no more than this in any entry.
inline constexpr double kOrientationTolerance = 1e-4;

// The largest entry of AᵀA − I, in absolute value.
double orthogonality_defect(const Eigen::Matrix3d& A);

// Of a matrix near SO(3): the polar factor. What is a rotation to rounding comes back as it is, to the last bit.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& A);

}  // namespace poinsot
