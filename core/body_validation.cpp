#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <unordered_map>

#include "core/counted.h"
#include "core/nearest_rotation.h"
#include "core/scene_validation.h"
#include "core/validation_rules.h"

namespace poinsot {
namespace {

using namespace rules;

void inertia(const Place& at, const Matrix3& J) {
  finite(at, "inertia", J);
  const double rounding = 1e-12 * J.cwiseAbs().maxCoeff();
  if (!((J - J.transpose()).cwiseAbs().maxCoeff() <= rounding)) {
    at.fail("inertia", "found a matrix that is not symmetric, expected 3 principal moments or a symmetric 3x3 matrix");
  }
  const Matrix3 symmetric = 0.5 * J + 0.5 * J.transpose();
  const double least =
      J.isDiagonal(0)
          ? J.diagonal().minCoeff()
          : Eigen::SelfAdjointEigenSolver<Matrix3>(symmetric, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
  if (!(least >= -rounding)) {
    at.fail("inertia", fmt::format("found a principal moment of {:.6g}, expected none below zero", least));
  }
}

void orientation(const Place& at, const Matrix3& A) {
  constexpr std::string_view kKey = "orientation/matrix";
  finite(at, kKey, A);
  constexpr double kFar = 10 * kOrientationTolerance;  // a defect that the tolerance, moving each entry, cannot reach
  const double defect = orthogonality_defect(A);
  if (!(defect <= kFar)) {
    at.fail(kKey, fmt::format("found a matrix A with AᵀA off the identity by {:.2g}, expected a rotation to within {}",
                              defect, kOrientationTolerance));
  }
  if (A.determinant() < 0) at.fail(kKey, "found a reflection (its determinant is -1), expected a rotation");
  if (const double moved = (nearest_rotation(A) - A).cwiseAbs().maxCoeff(); moved > kOrientationTolerance) {
    at.fail(kKey, fmt::format("found entries up to {:.2g} off the nearest rotation, expected at most {}", moved,
                              kOrientationTolerance));
  }
}

void shape(const Place& at, const Shape& s) {
  known(at, "shape/type", s.type);
  finite(at, "shape/at", s.at);
  switch (s.type) {
    case ShapeType::box:
      for (Eigen::Index k = 0; k < 3; ++k) positive(at, fmt::format("shape/size/{}", k), s.size[k]);
      break;
    case ShapeType::cylinder:
    case ShapeType::capsule:
      positive(at, "shape/length", s.length);
      direction(at, "shape/axis", s.axis);
      [[fallthrough]];
    case ShapeType::sphere:
      positive(at, "shape/radius", s.radius);
      break;
    case ShapeType::polyline:
      if (s.points.size() < 2)
        at.fail("shape/points", fmt::format("found an array of {}, expected an array of at least 2 points",
                                            counted(s.points.size(), "value")));
      for (std::size_t k = 0; k < s.points.size(); ++k) finite(at, fmt::format("shape/points/{}", k), s.points[k]);
      break;
  }
}

}  // namespace

void validate_bodies(const std::vector<Body>& bodies) {
  if (bodies.empty()) throw ElementError("/bodies: found an array of 0 values, expected at least one body", "/bodies");
  std::unordered_map<std::string_view, std::size_t> taken;
  taken.reserve(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Place at{"bodies", k};
    const Body& b = bodies[k];
    if (b.name.empty()) at.fail("name", "found \"\", expected a name of one character or more");
    name(at, b.name);
    if (b.name == "ground") {
      at.fail("name", "found \"ground\", which is body 0 and never listed, expected another name");
    }
    if (const auto [entry, is_new] = taken.emplace(b.name, k); !is_new) {
      already(at, "name", b.name, "", Place{"bodies", entry->second});
    }
    positive(at, "mass", b.mass);
    inertia(at, b.inertia);
    finite(at, "position", b.position);
    orientation(at, b.orientation);
    finite(at, "velocity", b.velocity);
    finite(at, "angular_velocity", b.angular_velocity);
    if (b.shape) shape(at, *b.shape);
  }
}

}  // namespace poinsot
