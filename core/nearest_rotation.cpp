#include "core/nearest_rotation.h"

#include <limits>

namespace poinsot {

double orthogonality_defect(const Eigen::Matrix3d& A) {
  return (A.transpose() * A - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

// Newton–Schulz: R ← R (3 I − RᵀR) / 2, quadratic near SO(3) and exact on I.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& A) {
  // products of rotations, and those that a run ends with, are off by a few roundings
  constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();
  if (orthogonality_defect(A) <= kRounding) return A;
  Eigen::Matrix3d R = A;
  for (int k = 0; k < 4; ++k) R = R * (1.5 * Eigen::Matrix3d::Identity() - 0.5 * R.transpose() * R);
  return R;
}

}  // namespace poinsot
