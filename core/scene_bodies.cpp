// One body of a scene file, and its shape. For each type of shape: the keys it has, then what they hold.
#include <fmt/format.h>

#include "core/scene_parts.h"
#include "core/scene_types.h"
#include "core/scene_values.h"

namespace poinsot {
namespace {

double read_positive(const JsonValue& value) {
  return value.number("a positive number");
}

Shape read_shape(const JsonValue& item) {
  const auto& [name, type] = read_entry(item.required("type"), kShapeTypes, one_of(kShapeTypes));
  Shape shape;
  shape.type = type;
  switch (type) {
    case ShapeType::box:
      item.keys("a box", {"type", "at", "size"});
      shape.size = read_vector(item.required("size"));
      break;
    case ShapeType::cylinder:
    case ShapeType::capsule:
      item.keys(fmt::format("a {}", name), {"type", "at", "radius", "length", "axis"});
      shape.radius = read_positive(item.required("radius"));
      shape.length = read_positive(item.required("length"));
      shape.axis = optional_or(item, "axis", read_vector, shape.axis);
      break;
    case ShapeType::sphere:
      item.keys("a sphere", {"type", "at", "radius"});
      shape.radius = read_positive(item.required("radius"));
      break;
    case ShapeType::polyline: {
      item.keys("a polyline", {"type", "points"});
      const JsonValue points = item.required("points");
      const std::size_t size = points.size("an array of at least 2 points");
      for (std::size_t k = 0; k < size; ++k) shape.points.push_back(read_vector(points.at(k)));
      break;
    }
  }
  shape.at = optional_or(item, "at", read_vector, shape.at);
  return shape;
}

}  // namespace

Body read_body(const JsonValue& item) {
  item.keys("a body", {"name", "mass", "inertia", "position", "orientation", "velocity", "angular_velocity", "shape"});
  Body body;
  body.name = read_name(item.required("name"));
  body.mass = item.required("mass").number("a positive number");
  body.inertia = read_inertia(item.required("inertia"));
  body.position = read_vector(item.required("position"));
  body.orientation = optional_or(item, "orientation", read_orientation, body.orientation);
  body.velocity = optional_or(item, "velocity", read_vector, body.velocity);
  body.angular_velocity = optional_or(item, "angular_velocity", read_vector, body.angular_velocity);
  if (const auto shape = item.optional("shape")) body.shape = read_shape(*shape);
  return body;
}

}  // namespace poinsot
