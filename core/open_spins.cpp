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

Matrix3 axes_without_moment(const Body& body) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> principal(body.inertia);
  const double most = principal.eigenvalues().cwiseAbs().maxCoeff();
  Matrix3 axes = Matrix3::Zero();
  for (int k = 0; k < 3; ++k)
    if (principal.eigenvalues()[k] <= kNoMoment * most) axes.col(k) = principal.eigenvectors().col(k);
  return axes;
}

Vector3 unheld_axis(const Matrix3& without_moment, const Matrix3& held, double least) {
  // w = without_moment x for some x that is not zero
  const Eigen::SelfAdjointEigenSolver<Matrix3> open(Matrix3(without_moment.transpose() * held * without_moment +
                                                            Matrix3::Identity() -
                                                            Matrix3(without_moment.transpose() * without_moment)));
  if (without_moment.isZero(0) || open.eigenvalues()[0] > least) return Vector3::Zero();
  return (without_moment * open.eigenvectors().col(0)).normalized();
}

std::string describe_no_moment(const Body& body, const Vector3& axis) {
  return fmt::format("body '{}' has no moment of inertia about the axis ({:.3g}, {:.3g}, {:.3g}) of its frame",
                     body.name, axis.x(), axis.y(), axis.z());
}

std::string open_spin(const Model& model) {
  std::vector<Matrix3> free;
  bool any = false;
  for (const Body& body : model.bodies) any |= !free.emplace_back(axes_without_moment(body)).isZero(0);
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
    const Vector3 w = unheld_axis(free[b], held[b], kAlong * kAlong);
    if (w.isZero(0)) continue;
    return describe_no_moment(model.bodies[b], w) +
           ", and no constraint holds it about that: nothing says how it spins; give it a small moment there";
  }
  return {};
}

}  // namespace poinsot
