// One body of a scene file.
#include "core/scene_parts.h"
#include "core/scene_values.h"

namespace poinsot {

Body read_body(const JsonValue& item) {
  item.keys("a body", {"name", "mass", "inertia", "position", "orientation", "velocity", "angular_velocity"});
  Body body;
  body.name = read_name(item.required("name"));
  body.mass = item.required("mass").number("a positive number");
  body.inertia = read_inertia(item.required("inertia"));
  body.position = read_vector(item.required("position"));
  body.orientation = optional_or(item, "orientation", read_orientation, body.orientation);
  body.velocity = optional_or(item, "velocity", read_vector, body.velocity);
  body.angular_velocity = optional_or(item, "angular_velocity", read_vector, body.angular_velocity);
  return body;
}

}  // namespace poinsot
