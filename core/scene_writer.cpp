#include "core/scene_writer.h"

#include <fmt/format.h>

#include <iterator>
#include <string_view>

#include "core/check.h"
#include "core/scene_types.h"

namespace poinsot {
namespace {

// Adding zero turns −0 into 0: the sign of a zero says nothing in a scene.
std::string vector(const Vector3& v) {
  return fmt::format("[{}, {}, {}]", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

std::string shape(const Shape& s) {
  std::string text = fmt::format("{{\"type\": \"{}\"", type_name(s.type));
  if (!s.at.isZero(0)) text += fmt::format(", \"at\": {}", vector(s.at));
  switch (s.type) {
    case ShapeType::box:
      text += fmt::format(", \"size\": {}", vector(s.size));
      break;
    case ShapeType::cylinder:
    case ShapeType::capsule:
      text += fmt::format(", \"length\": {}, \"axis\": {}", s.length, vector(s.axis));
      [[fallthrough]];
    case ShapeType::sphere:
      text += fmt::format(", \"radius\": {}", s.radius);
      break;
    case ShapeType::polyline:
      for (const Vector3& point : s.points)
        text += (&point == s.points.data() ? ", \"points\": [" : ", ") + vector(point);
      text += "]";
      break;
  }
  return text + "}";
}

std::string body(const Body& b) {
  check(b.inertia.isDiagonal(0), "generated bodies have principal axes");
  std::string text = fmt::format(
      "{{\"name\": \"{}\", \"mass\": {}, \"inertia\": {}, \"position\": {}, \"orientation\": {{\"matrix\": [", b.name,
      b.mass, vector(b.inertia.diagonal()), vector(b.position));
  for (int row = 0; row < 3; ++row) text += (row ? ", " : "") + vector(b.orientation.row(row));
  text += "]}";
  if (!b.velocity.isZero(0)) text += fmt::format(", \"velocity\": {}", vector(b.velocity));
  if (!b.angular_velocity.isZero(0)) text += fmt::format(", \"angular_velocity\": {}", vector(b.angular_velocity));
  if (b.shape) text += fmt::format(", \"shape\": {}", shape(*b.shape));
  return text + "}";
}

// Those that the type has and that are given.
std::string frames_members(JointType type, const JointFrames& f) {
  std::string text = fmt::format(", \"s_i\": {}, \"s_j\": {}", vector(f.s_i), vector(f.s_j));
  if (type == JointType::spherical) return text;
  text += fmt::format(", \"axis_i\": {}, \"axis_j\": {}", vector(f.axis_i), vector(f.axis_j));
  if (!f.a_i.isZero(0)) text += fmt::format(", \"a_i\": {}, \"a_j\": {}", vector(f.a_i), vector(f.a_j));
  return text;
}

std::string joint(const Scene& scene, const Joint& j) {
  const auto name = [&](int b) -> std::string_view {
    return b == kGround ? "ground" : std::string_view(scene.bodies[static_cast<std::size_t>(b)].name);
  };
  std::string text = fmt::format(R"({{"type": "{}", "name": "{}", "bodies": ["{}", "{}"])", type_name(j.type), j.name,
                                 name(j.i), name(j.j));
  if (j.frames) return text + frames_members(j.type, *j.frames) + "}";
  text += fmt::format(", \"point\": {}", vector(j.point));
  if (!j.axis.isZero(0)) text += fmt::format(", \"axis\": {}", vector(j.axis));
  if (!j.axis_i.isZero(0)) text += fmt::format(", \"axis_i\": {}, \"axis_j\": {}", vector(j.axis_i), vector(j.axis_j));
  return text + "}";
}

}  // namespace

std::string to_json(const Scene& scene) {
  check(scene.constraints.empty() && scene.drivers.empty() && scene.forces.empty(),
        "generated scenes have joints only");
  std::string text = fmt::format(
      "{{\n  \"scene\": 1,\n  \"name\": \"{}\",\n  \"about\": \"{}\",\n  \"gravity\": {},\n  \"bodies\": [\n",
      scene.name, scene.about, vector(scene.gravity));
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    text += fmt::format("{}    {}", k ? ",\n" : "", body(scene.bodies[k]));
  }
  text += "\n  ],\n  \"joints\": [\n";
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    text += fmt::format("{}    {}", k ? ",\n" : "", joint(scene, scene.joints[k]));
  }
  return text + "\n  ]\n}\n";
}

}  // namespace poinsot
