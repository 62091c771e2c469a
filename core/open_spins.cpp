#include "core/open_spins.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "core/index.h"

namespace poinsot {
namespace {

constexpr double kNoMoment = 1e-14;  // of a body's largest
constexpr double kAlong = 1e-7;      // of a vector's length: across the axis

// wᵀ H w = |w × ê|²: how much a vector of a row holds a rotation w of its body.
Matrix3 held_by(const Vector3& e) {
  const double length = e.norm();
  if (!(length > 0)) return Matrix3::Zero();
  const Vector3 u = e / length;
  return Matrix3::Identity() - u * u.transpose();
}

}  // namespace

std::string open_spin(const Model& model) {
  std::vector<Matrix3> free(model.bodies.size(), Matrix3::Zero());  // columns: axes without moment
  bool any = false;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Eigen::SelfAdjointEigenSolver<Matrix3> principal(model.bodies[b].inertia);
    const double most = principal.eigenvalues().cwiseAbs().maxCoeff();
    for (int k = 0; k < 3; ++k) {
      if (principal.eigenvalues()[k] > kNoMoment * most) continue;
      free[b].col(k) = principal.eigenvectors().col(k);
      any = true;
    }
  }
  if (!any) return {};
  std::vector<Matrix3> held(model.bodies.size(), Matrix3::Zero());
  for (const Row& row : model.rows) {
    if (row.i != kGround)
      for (const Vector3* e : {&row.a_i, &row.b_i, &row.s_i}) held[index(row.i)] += held_by(*e);
    if (row.j != kGround)
      for (const Vector3* e : {&row.a_j, &row.s_j}) held[index(row.j)] += held_by(*e);
    if (row.alternate && row.i != kGround) held[index(row.i)] += held_by(row.alternate->a_i);
    if (row.alternate && row.j != kGround) held[index(row.j)] += held_by(row.alternate->a_j);
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (free[b].isZero(0)) continue;
    // w = free x for some x that is not zero, and no more than rounding of it held.
    const Eigen::SelfAdjointEigenSolver<Matrix3> open(Matrix3(
        free[b].transpose() * held[b] * free[b] + Matrix3::Identity() - Matrix3(free[b].transpose() * free[b])));
    if (open.eigenvalues()[0] > kAlong * kAlong) continue;
    const Vector3 w = (free[b] * open.eigenvectors().col(0)).normalized();
    return fmt::format(
        "body '{}' has no moment of inertia about the axis ({:.3g}, {:.3g}, {:.3g}) of its frame, and no constraint "
        "holds it about that: nothing says how it spins; give it a small moment there",
        model.bodies[b].name, w.x(), w.y(), w.z());
  }
  return {};
}

}  // namespace poinsot
