// The values that scenes are made of, read and checked: vectors, directions, functions of time, inertias, orientations.
#pragma once

#include "core/expression.h"
#include "core/json_value.h"
#include "core/scene.h"

namespace poinsot {

Vector3 read_vector(const JsonValue& value);
Vector3 read_direction(const JsonValue& value);  // not zero; its length is kept
Vector3 read_axis(const JsonValue& value);       // not zero; normalized
Expression read_function(const JsonValue& value);

// Three principal moments, or a symmetric 3 × 3 matrix; positive semidefinite. kg m². The triangle inequalities of
// principal moments are not asked for: idealized bodies such as diag(4, 2, 0) are in use.
Matrix3 read_inertia(const JsonValue& value);

// {"matrix"}, {"euler_parameters"}, {"axis", "angle"} or {"zxz"}: A = Rz(φ) Rx(θ) Rz(ψ). What is given to a few digits
// is projected to SO(3) where that moves no entry by more than kOrientationTolerance, and refused beyond.
Matrix3 read_orientation(const JsonValue& value);
inline constexpr double kOrientationTolerance = 1e-4;

// "item" read from the object, or `otherwise` where the key is absent.
template <class T>
T optional_or(const JsonValue& object, std::string_view key, T (*read)(const JsonValue&), T otherwise) {
  const std::optional<JsonValue> value = object.optional(key);
  return value ? read(*value) : otherwise;
}

}  // namespace poinsot
