#include "core/scene_reader.h"

#include <fmt/format.h>

#include "core/input_error.h"
#include "core/json_document.h"
#include "core/scene_parts.h"
#include "core/scene_validation.h"
#include "core/scene_values.h"

namespace poinsot {
namespace {

// Calls read(item) for every item of a section; an absent section has none.
template <class Read>
void for_each(const JsonValue& root, std::string_view section, const std::string& allowed, Read read) {
  const std::optional<JsonValue> list = root.optional(section);
  if (!list) return;
  const std::size_t size = list->size(allowed);
  for (std::size_t k = 0; k < size; ++k) {
    const JsonValue item = list->at(k);
    read(item);
  }
}

template <class Validate>
void in_file(std::string_view file, Validate validate) {
  try {
    validate();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

}  // namespace

Scene parse_scene(std::string_view text, std::string_view file) {
  const JsonDocument document(text, file);
  const JsonValue root = document.root();
  root.keys("a scene", {"scene", "name", "about", "gravity", "bodies", "constraints", "joints", "drivers", "forces"});
  const JsonValue version = root.required("scene");
  constexpr std::string_view kVersion = "1, the version of the format";
  if (version.is_string() || version.number(kVersion) != 1) version.expected(kVersion);

  Scene scene;
  if (const auto name = root.optional("name")) scene.name = name->string();
  if (const auto about = root.optional("about")) scene.about = about->string();
  scene.gravity = optional_or(root, "gravity", read_vector, scene.gravity);

  (void)root.required("bodies");
  for_each(root, "bodies", "an array of bodies",
           [&](const JsonValue& item) { scene.bodies.push_back(read_body(item)); });
  in_file(file, [&] { validate_bodies(scene.bodies); });
  const BodyNames bodies(scene.bodies);
  for_each(root, "constraints", "an array of constraints",
           [&](const JsonValue& item) { scene.constraints.push_back(read_constraint(item, bodies)); });
  for_each(root, "joints", "an array of joints",
           [&](const JsonValue& item) { scene.joints.push_back(read_joint(item, bodies)); });
  for_each(root, "drivers", "an array of drivers",
           [&](const JsonValue& item) { scene.drivers.push_back(read_driver(item, bodies)); });
  for_each(root, "forces", "an array of forces",
           [&](const JsonValue& item) { scene.forces.push_back(read_force(item, bodies)); });
  in_file(file, [&] { validate(scene); });

  scene.source = text;
  return scene;
}

Scene read_scene(const std::filesystem::path& file) {
  return parse_scene(read_text(file.string()), shown_input(file.string()));
}

}  // namespace poinsot
