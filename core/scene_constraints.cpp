// Constraints, joints and drivers. For each type: the keys it has, then what they hold.
#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "core/scene_parts.h"
#include "core/scene_types.h"
#include "core/scene_values.h"

namespace poinsot {
namespace {

void read_points(const JsonValue& item, Vector3& s_i, Vector3& s_j) {
  s_i = read_vector(item.required("s_i"));
  s_j = read_vector(item.required("s_j"));
}

Constraint::Alternate read_alternate(const JsonValue& value) {
  value.keys("an alternate", {"a_i", "a_j", "f"});
  return {read_vector(value.required("a_i")), read_vector(value.required("a_j")), read_function(value.required("f"))};
}

bool has_any(const JsonValue& item, std::initializer_list<std::string_view> keys) {
  return std::ranges::any_of(keys, [&](std::string_view key) { return item.optional(key).has_value(); });
}

// In the place of "point" and global axes.
JointFrames read_frames(const JsonValue& item, std::string_view owner, JointType type) {
  JointFrames frames;
  if (type == JointType::spherical) {
    item.keys(owner, {"type", "name", "bodies", "s_i", "s_j"});
  } else {
    item.keys(owner, {"type", "name", "bodies", "s_i", "s_j", "axis_i", "axis_j", "a_i", "a_j"});
    frames.axis_i = read_vector(item.required("axis_i"));
    frames.axis_j = read_vector(item.required("axis_j"));
    if (type == JointType::translational || type == JointType::fixed) (void)item.required("a_i");
    read_references(item, frames.a_i, frames.a_j);
  }
  read_points(item, frames.s_i, frames.s_j);
  return frames;
}

}  // namespace

Constraint read_constraint(const JsonValue& item, const BodyNames& bodies) {
  const ConstraintType type = read_entry(item.required("type"), kConstraintTypes).type;
  Constraint c;
  c.type = type;
  switch (type) {
    case ConstraintType::DP1:
      item.keys("a DP1", {"type", "name", "bodies", "a_i", "a_j", "f", "alternate"});
      c.a_i = read_vector(item.required("a_i"));
      c.a_j = read_vector(item.required("a_j"));
      if (const auto alternate = item.optional("alternate")) c.alternate = read_alternate(*alternate);
      break;
    case ConstraintType::DP2:
      item.keys("a DP2", {"type", "name", "bodies", "a_i", "s_i", "s_j", "f"});
      c.a_i = read_vector(item.required("a_i"));
      break;
    case ConstraintType::D:
      item.keys("a D", {"type", "name", "bodies", "s_i", "s_j", "f"});
      break;
    case ConstraintType::CD:
      item.keys("a CD", {"type", "name", "bodies", "c", "s_i", "s_j", "f"});
      c.c = read_vector(item.required("c"));
      break;
    case ConstraintType::pfaffian:
      item.keys("a pfaffian constraint", {"type", "name", "bodies", "a_j", "s_i", "s_j", "f"});
      c.a_j = read_vector(item.required("a_j"));
      break;
  }
  if (type != ConstraintType::DP1) read_points(item, c.s_i, c.s_j);
  std::tie(c.i, c.j) = bodies.read_pair(item.required("bodies"));
  c.f = optional_or(item, "f", read_function, Expression());
  c.name = optional_or(item, "name", read_name, std::string());
  return c;
}

Joint read_joint(const JsonValue& item, const BodyNames& bodies) {
  const auto& [type_name, type] = read_entry(item.required("type"), kJointTypes);
  Joint j;
  j.type = type;
  if (has_any(item, {"s_i", "s_j"})) {
    if (has_any(item, {"point", "axis"})) {
      item.fail("found a joint in the bodies' frames (s_i, s_j) and globally (point, axis), expected one of the two");
    }
    j.frames = read_frames(item, fmt::format("a {} joint in the bodies' frames", type_name), type);
  } else {
    const std::string owner = fmt::format("a {} joint", type_name);
    if (type == JointType::spherical || type == JointType::fixed) {
      item.keys(owner, {"type", "name", "bodies", "point"});
    } else if (type == JointType::universal) {
      item.keys(owner, {"type", "name", "bodies", "point", "axis_i", "axis_j"});
      j.axis_i = read_vector(item.required("axis_i"));
      j.axis_j = read_vector(item.required("axis_j"));
    } else {
      item.keys(owner, {"type", "name", "bodies", "point", "axis"});
      j.axis = read_vector(item.required("axis"));
    }
    j.point = read_vector(item.required("point"));
  }
  std::tie(j.i, j.j) = bodies.read_pair(item.required("bodies"));
  j.name = optional_or(item, "name", read_name, std::string());
  return j;
}

Driver read_driver(const JsonValue& item, const BodyNames& bodies) {
  const DriverType type = read_entry(item.required("type"), kDriverTypes).type;
  Driver d;
  d.type = type;
  if (type == DriverType::angle) {
    item.keys("an angle driver", {"type", "name", "bodies", "axis", "a_i", "a_j", "angle"});
    d.axis = read_vector(item.required("axis"));
    read_references(item, d.a_i, d.a_j);
    d.value = read_function(item.required("angle"));
  } else {
    item.keys("a distance driver", {"type", "name", "bodies", "s_i", "s_j", "length"});
    read_points(item, d.s_i, d.s_j);
    d.value = read_function(item.required("length"));
  }
  std::tie(d.i, d.j) = bodies.read_pair(item.required("bodies"));
  d.name = optional_or(item, "name", read_name, std::string());
  return d;
}

}  // namespace poinsot
