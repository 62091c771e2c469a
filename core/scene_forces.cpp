// Applied forces of a scene file. For each type: the keys it has, then what they hold.
#include <tuple>

#include "core/scene_parts.h"
#include "core/scene_types.h"
#include "core/scene_values.h"

namespace poinsot {
namespace {

Frame read_frame(const JsonValue& value) {
  return read_entry(value, kFrames, one_of(kFrames)).type;
}

void read_functions(const JsonValue& value, Expression (&out)[3]) {
  constexpr std::string_view kAllowed = "an array of 3 numbers or strings holding expressions in t";
  if (value.size(kAllowed) != 3) value.expected(kAllowed);
  for (std::size_t k = 0; k < 3; ++k) out[k] = read_function(value.at(k));
}

double read_number(const JsonValue& value) {
  return value.number();
}

Force read_point_force(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a force", {"type", "name", "body", "point", "force", "frame"});
  PointForce force;
  force.body = bodies.read_moving(item.required("body"));
  force.point = read_vector(item.required("point"));
  read_functions(item.required("force"), force.force);
  force.frame = optional_or(item, "frame", read_frame, Frame::global);
  return force;
}

Force read_torque(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a torque", {"type", "name", "body", "torque", "frame"});
  Torque torque;
  torque.body = bodies.read_moving(item.required("body"));
  read_functions(item.required("torque"), torque.torque);
  torque.frame = optional_or(item, "frame", read_frame, Frame::body);
  return torque;
}

// A law, or stiffness and damping.
template <class Spring>
void read_law(const JsonValue& item, Spring& spring) {
  if (const std::optional<JsonValue> law = item.optional("law")) {
    for (const std::string_view other : {"stiffness", "damping"})
      if (const auto beside = item.optional(other)) beside->fail("found one beside a law, expected one or the other");
    spring.law = read_law(*law);
  } else {
    if (!item.optional("stiffness")) item.fail("found neither stiffness nor law, expected one of them");
    spring.stiffness = item.required("stiffness").number();
    spring.damping = optional_or(item, "damping", read_number, 0.0);
  }
}

Force read_spring(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a spring", {"type", "name", "bodies", "s_i", "s_j", "stiffness", "damping", "length", "law"});
  Spring spring;
  std::tie(spring.i, spring.j) = bodies.read_pair(item.required("bodies"));
  spring.s_i = read_vector(item.required("s_i"));
  spring.s_j = read_vector(item.required("s_j"));
  read_law(item, spring);
  spring.length = item.required("length").number("a number that is not negative");
  return spring;
}

Force read_torsion_spring(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a torsion spring",
            {"type", "name", "bodies", "axis", "a_i", "a_j", "stiffness", "damping", "angle", "law"});
  TorsionSpring spring;
  std::tie(spring.i, spring.j) = bodies.read_pair(item.required("bodies"));
  spring.axis = read_vector(item.required("axis"));
  read_references(item, spring.a_i, spring.a_j);
  read_law(item, spring);
  spring.angle = optional_or(item, "angle", read_number, 0.0);
  return spring;
}

Force read_linear_drag(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a linear drag", {"type", "name", "body", "translational", "rotational"});
  LinearDrag drag;
  drag.body = bodies.read_moving(item.required("body"));
  drag.translational = optional_or(item, "translational", read_number, 0.0);
  drag.rotational = optional_or(item, "rotational", read_number, 0.0);
  return drag;
}

// In the order of kForceTypes.
constexpr Force (*kRead[])(const JsonValue& item, const BodyNames& bodies) = {
    read_point_force, read_torque, read_spring, read_torsion_spring, read_linear_drag};
static_assert(std::size(kRead) == std::size(kForceTypes));

}  // namespace

Force read_force(const JsonValue& item, const BodyNames& bodies) {
  Force force = kRead[read_entry(item.required("type"), kForceTypes).type](item, bodies);
  std::visit([&](auto& concrete) { concrete.name = optional_or(item, "name", read_name, std::string()); }, force);
  return force;
}

}  // namespace poinsot
