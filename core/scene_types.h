// How scenes write the types of constraints, joints, drivers, forces and shapes, and the frames that loads are given
// in.
#pragma once

#include <cstddef>
#include <string>

#include "core/scene.h"

namespace poinsot {

template <class Type>
struct TypeName {
  const char* name;
  Type type;
};

// In the order of the enumerations, which is what type_name() looks up by.
inline constexpr TypeName<ConstraintType> kConstraintTypes[] = {{"DP1", ConstraintType::DP1},
                                                                {"DP2", ConstraintType::DP2},
                                                                {"D", ConstraintType::D},
                                                                {"CD", ConstraintType::CD},
                                                                {"pfaffian", ConstraintType::pfaffian}};
inline constexpr TypeName<JointType> kJointTypes[] = {
    {"revolute", JointType::revolute},           {"spherical", JointType::spherical},
    {"universal", JointType::universal},         {"cylindrical", JointType::cylindrical},
    {"translational", JointType::translational}, {"fixed", JointType::fixed}};
inline constexpr TypeName<DriverType> kDriverTypes[] = {{"angle", DriverType::angle},
                                                        {"distance", DriverType::distance}};
inline constexpr TypeName<ShapeType> kShapeTypes[] = {{"box", ShapeType::box},
                                                      {"cylinder", ShapeType::cylinder},
                                                      {"capsule", ShapeType::capsule},
                                                      {"sphere", ShapeType::sphere},
                                                      {"polyline", ShapeType::polyline}};
inline constexpr TypeName<Frame> kFrames[] = {{"global", Frame::global}, {"body", Frame::body}};
// The type of a force is its place in the variant; the last, of callbacks, is for programs alone.
inline constexpr TypeName<std::size_t> kForceTypes[] = {
    {"force", 0}, {"torque", 1}, {"spring", 2}, {"torsion_spring", 3}, {"linear_drag", 4}};
static_assert(std::size(kForceTypes) + 1 == std::variant_size_v<Force>);

constexpr const auto& type_names(ConstraintType) {
  return kConstraintTypes;
}
constexpr const auto& type_names(JointType) {
  return kJointTypes;
}
constexpr const auto& type_names(DriverType) {
  return kDriverTypes;
}
constexpr const auto& type_names(ShapeType) {
  return kShapeTypes;
}
constexpr const auto& type_names(Frame) {
  return kFrames;
}

template <class Type>
constexpr const char* type_name(Type type) {
  return type_names(type)[static_cast<std::size_t>(type)].name;
}
inline const char* type_name(const Force& force) {
  return std::holds_alternative<CallbackForce>(force) ? "callback" : kForceTypes[force.index()].name;
}

// "one of DP1, DP2, D, CD, pfaffian"
template <class Type, std::size_t N>
std::string one_of(const TypeName<Type> (&table)[N]) {
  std::string text = "one of ";
  for (const TypeName<Type>& entry : table) text += (&entry == table ? "" : ", ") + std::string(entry.name);
  return text;
}

}  // namespace poinsot
