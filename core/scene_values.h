// The values that scenes are made of, read: names, vectors, functions of time, laws, inertias, orientations.
#pragma once

#include <algorithm>
#include <string>

#include "core/expression.h"
#include "core/json_value.h"
#include "core/scene.h"
#include "core/scene_types.h"

namespace poinsot {

std::string read_name(const JsonValue& value);  // not empty
Vector3 read_vector(const JsonValue& value);
Expression read_function(const JsonValue& value);
Expression read_law(const JsonValue& value);  // of a spring

// The keys "a_i" and "a_j", both or neither: then the directions stay as they are.
void read_references(const JsonValue& item, Vector3& a_i, Vector3& a_j);

// The entry of a table of names that the text is one of; `allowed` is what is said of what is no text.
template <class Type, std::size_t N>
const TypeName<Type>& read_entry(const JsonValue& value, const TypeName<Type> (&table)[N],
                                 std::string_view allowed = "a string") {
  const auto* entry = std::ranges::find(table, value.string(allowed), &TypeName<Type>::name);
  if (entry == std::end(table)) value.expected(one_of(table));
  return *entry;
}

// Three principal moments, or a 3 × 3 matrix. kg m².
Matrix3 read_inertia(const JsonValue& value);

// {"matrix"}, {"euler_parameters"}, {"axis", "angle"} or {"zxz"}: A = Rz(φ) Rx(θ) Rz(ψ).
Matrix3 read_orientation(const JsonValue& value);

// "item" read from the object, or `otherwise` where the key is absent.
template <class T>
T optional_or(const JsonValue& object, std::string_view key, T (*read)(const JsonValue&), T otherwise) {
  const std::optional<JsonValue> value = object.optional(key);
  return value ? read(*value) : otherwise;
}

}  // namespace poinsot
