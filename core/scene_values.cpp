#include "core/scene_values.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "core/nearest_rotation.h"
#include "core/printable.h"

namespace poinsot {
namespace {

Matrix3 read_matrix(const JsonValue& value, std::string_view allowed) {
  if (value.size(allowed) != 3) value.expected(allowed);
  Matrix3 matrix;
  for (std::size_t k = 0; k < 3; ++k) matrix.row(static_cast<Eigen::Index>(k)) = read_vector(value.at(k)).transpose();
  return matrix;
}

Matrix3 read_euler_parameters(const JsonValue& value) {
  constexpr std::string_view kAllowed = "4 numbers, e0 to e3";
  if (value.size(kAllowed) != 4) value.expected(kAllowed);
  Eigen::Vector4d p;
  for (std::size_t k = 0; k < 4; ++k) p[static_cast<Eigen::Index>(k)] = value.at(k).number();
  const double norm = p.norm();
  if (!(std::abs(norm - 1) <= kOrientationTolerance)) {
    value.fail(
        fmt::format("found Euler parameters of norm {:.6g}, expected 1 to within {}", norm, kOrientationTolerance));
  }
  p /= norm;
  return Eigen::Quaterniond(p[0], p[1], p[2], p[3]).toRotationMatrix();
}

Expression read_expression(const JsonValue& value, Expression (*parse)(std::string_view, ExpressionNames*),
                           std::string_view allowed) {
  if (!value.is_string()) return Expression(value.number(allowed));
  try {
    return parse(value.string(), value.expression_names());
  } catch (const ExpressionError& error) {
    value.fail(fmt::format("found \"{}\" ({}), expected {}", printable(value.string()), error.what(), allowed));
  }
}

Matrix3 turn(double angle, const Vector3& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

}  // namespace

std::string read_name(const JsonValue& value) {
  constexpr std::string_view kAllowed = "a name of one character or more";
  const std::string& name = value.string(kAllowed);
  if (name.empty()) value.expected(kAllowed);
  return name;
}

Vector3 read_vector(const JsonValue& value) {
  constexpr std::string_view kAllowed = "an array of 3 numbers";
  if (value.size(kAllowed) != 3) value.expected(kAllowed);
  Vector3 vector;
  for (std::size_t k = 0; k < 3; ++k) vector[static_cast<Eigen::Index>(k)] = value.at(k).number();
  return vector;
}

void read_references(const JsonValue& item, Vector3& a_i, Vector3& a_j) {
  if (!item.optional("a_i") && !item.optional("a_j")) return;
  for (const auto& [key, direction] : {std::pair("a_i", &a_i), std::pair("a_j", &a_j)}) {
    const JsonValue value = item.required(key);
    *direction = read_vector(value);
    if (direction->isZero(0)) value.fail("found the zero vector, expected a direction");
  }
}

Expression read_function(const JsonValue& value) {
  return read_expression(value, Expression::parse, "a number or a string holding an expression in t");
}

Expression read_law(const JsonValue& value) {
  return read_expression(value, Expression::parse_law, "a number or a string holding an expression in x, v and t");
}

Matrix3 read_inertia(const JsonValue& value) {
  constexpr std::string_view kAllowed = "3 principal moments or a symmetric 3x3 matrix";
  if (value.size(kAllowed) != 3) value.expected(kAllowed);
  return value.at(0).is_array() ? read_matrix(value, kAllowed) : Matrix3(read_vector(value).asDiagonal());
}

Matrix3 read_orientation(const JsonValue& value) {
  value.keys("an orientation", {"matrix", "euler_parameters", "axis", "angle", "zxz"});
  const auto matrix = value.optional("matrix"), parameters = value.optional("euler_parameters");
  const auto axis = value.optional("axis"), angle = value.optional("angle"), zxz = value.optional("zxz");
  const int spellings = matrix.has_value() + parameters.has_value() + (axis || angle) + zxz.has_value();
  if (spellings != 1) {
    value.fail(
        fmt::format("found {} orientation, expected exactly one of matrix, euler_parameters, axis with angle, zxz",
                    spellings == 0 ? "no" : "more than one"));
  }
  if (matrix) return read_matrix(*matrix, "a 3x3 matrix as 3 rows");
  if (parameters) return read_euler_parameters(*parameters);
  if (zxz) {
    const Vector3 angles = read_vector(*zxz);
    return turn(angles[0], Vector3::UnitZ()) * turn(angles[1], Vector3::UnitX()) * turn(angles[2], Vector3::UnitZ());
  }
  const JsonValue about = value.required("axis");
  const Vector3 direction = read_vector(about);
  if (direction.isZero(0)) about.fail("found the zero vector, expected a direction");
  return turn(value.required("angle").number(), direction.stableNormalized());
}

}  // namespace poinsot
