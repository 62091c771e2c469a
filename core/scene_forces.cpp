// Applied forces of a scene file. For each type: the keys it has, then what they hold.
#include <algorithm>
#include <tuple>

#include "core/scene_parts.h"
#include "core/scene_values.h"

namespace poinsot {
namespace {

Frame read_frame(const JsonValue& item, Frame otherwise) {
  const std::optional<JsonValue> value = item.optional("frame");
  if (!value) return otherwise;
  constexpr std::string_view kAllowed = "one of global, body";
  const std::string& name = value->string(kAllowed);
  if (name == "global") return Frame::global;
  if (name == "body") return Frame::body;
  value->expected(kAllowed);
}

void read_functions(const JsonValue& value, Expression (&out)[3]) {
  constexpr std::string_view kAllowed = "an array of 3 numbers or strings holding expressions in t";
  if (value.size(kAllowed) != 3) value.expected(kAllowed);
  for (std::size_t k = 0; k < 3; ++k) {
    const JsonValue component = value.at(k);
    out[k] = read_function(component);
  }
}

double read_number(const JsonValue& value) {
  return value.number();
}

PointForce read_point_force(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a force", {"type", "name", "body", "point", "force", "frame"});
  PointForce force;
  force.body = bodies.read_moving(item.required("body"));
  force.point = read_vector(item.required("point"));
  read_functions(item.required("force"), force.force);
  force.frame = read_frame(item, Frame::global);
  return force;
}

Torque read_torque(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a torque", {"type", "name", "body", "torque", "frame"});
  Torque torque;
  torque.body = bodies.read_moving(item.required("body"));
  read_functions(item.required("torque"), torque.torque);
  torque.frame = read_frame(item, Frame::body);
  return torque;
}

Spring read_spring(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a spring", {"type", "name", "bodies", "s_i", "s_j", "stiffness", "damping", "length"});
  Spring spring;
  std::tie(spring.i, spring.j) = bodies.read_pair(item.required("bodies"));
  spring.s_i = read_vector(item.required("s_i"));
  spring.s_j = read_vector(item.required("s_j"));
  spring.stiffness = item.required("stiffness").number();
  spring.damping = optional_or(item, "damping", read_number, 0.0);
  const JsonValue length = item.required("length");
  spring.length = length.number("a number that is not negative");
  if (spring.length < 0) length.expected("a number that is not negative");
  return spring;
}

TorsionSpring read_torsion_spring(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a torsion spring", {"type", "name", "bodies", "axis", "stiffness", "damping", "angle"});
  TorsionSpring spring;
  std::tie(spring.i, spring.j) = bodies.read_pair(item.required("bodies"));
  spring.axis = read_axis(item.required("axis"));
  spring.stiffness = item.required("stiffness").number();
  spring.damping = optional_or(item, "damping", read_number, 0.0);
  spring.angle = optional_or(item, "angle", read_number, 0.0);
  return spring;
}

LinearDrag read_linear_drag(const JsonValue& item, const BodyNames& bodies) {
  item.keys("a linear drag", {"type", "name", "body", "translational", "rotational"});
  LinearDrag drag;
  drag.body = bodies.read_moving(item.required("body"));
  drag.translational = optional_or(item, "translational", read_number, 0.0);
  drag.rotational = optional_or(item, "rotational", read_number, 0.0);
  return drag;
}

template <auto read>
Force as_force(const JsonValue& item, const BodyNames& bodies) {
  return read(item, bodies);
}

struct ForceType {
  const char* name;
  Force (*read)(const JsonValue& item, const BodyNames& bodies);
};
constexpr ForceType kForces[] = {{"force", as_force<read_point_force>},
                                 {"torque", as_force<read_torque>},
                                 {"spring", as_force<read_spring>},
                                 {"torsion_spring", as_force<read_torsion_spring>},
                                 {"linear_drag", as_force<read_linear_drag>}};

}  // namespace

Force read_force(const JsonValue& item, const BodyNames& bodies, ItemNames& names) {
  const JsonValue type = item.required("type");
  const std::string& type_name = type.string();
  const ForceType* entry = std::ranges::find(kForces, type_name, &ForceType::name);
  if (entry == std::end(kForces)) {
    std::string allowed;
    for (const ForceType& known : kForces) allowed += (allowed.empty() ? "" : ", ") + std::string(known.name);
    type.expected("one of " + allowed);
  }
  Force force = entry->read(item, bodies);
  std::visit([&](auto& concrete) { concrete.name = names.next(item, type_name); }, force);
  return force;
}

}  // namespace poinsot
