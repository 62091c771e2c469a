#include "core/scene_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/definitions.h"
#include "core/input_error.h"
#include "core/json_document.h"
#include "core/places.h"
#include "core/printable.h"
#include "core/scene_parts.h"
#include "core/scene_validation.h"
#include "core/scene_values.h"
#include "core/table_file.h"
#include "core/varied_scene.h"

namespace poinsot {
namespace {

template <class Validate>
void in_file(std::string_view file, Validate validate) {
  try {
    validate();
  } catch (const ElementError& error) {
    throw ElementError(fmt::format("{}: {}", file, error.what()), error.path());
  }
}

// Values from outside take the place of the file's.
bool set_parameters(JsonDocument& document, const ParameterValues& values) {
  const JsonValue root = document.root();
  const std::optional<JsonValue> section = root.optional("parameters");
  const std::vector<std::string> known =
      section ? section->names("an object of parameters by name") : std::vector<std::string>();
  for (const auto& [name, value] : values) {
    if (std::ranges::find(known, name) == known.end()) {
      root.fail(fmt::format("there is no parameter '{}' to set; the scene has {}", printable(name),
                            known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
    }
    document.replace("/parameters/" + name, value);  // the names of parameters need no escapes
  }
  return !values.empty();
}

// Tables that name a file come to hold its points.
bool load_tables(JsonDocument& document, const std::filesystem::path& folder) {
  const JsonValue root = document.root();
  const std::optional<JsonValue> section = root.optional("tables");
  if (!section) return false;
  bool any = false;
  for (const std::string& name : section->names("an object of tables by name")) {
    const JsonValue item = section->required(name);
    const std::optional<JsonValue> file = item.optional("file");
    if (!file) continue;
    item.keys("a table of a file", {"file", "columns"});
    std::size_t columns[2] = {0, 1};
    if (const auto chosen = item.optional("columns")) {
      constexpr std::string_view kAllowed = "2 columns, counted from 0, that of x and that of y";
      if (chosen->size(kAllowed) != 2) chosen->expected(kAllowed);
      for (std::size_t k = 0; k < 2; ++k) {
        constexpr double kMost = 1e6;
        const JsonValue column = chosen->at(k);
        const double number = column.number(kAllowed);
        if (!(number >= 0 && number <= kMost && number == std::floor(number))) column.expected(kAllowed);
        columns[k] = static_cast<std::size_t>(number);
      }
    }
    nlohmann::json points = nlohmann::json::array();
    try {
      for (const auto& [x, y] : read_columns(folder / file->string("the name of a file"), columns[0], columns[1]))
        points.push_back({x, y});
    } catch (const InputError& error) {
      file->fail(error.what());
    }
    document.replace("/tables/" + pointer_token(name), {{"points", points}});
    any = true;
  }
  return any;
}

// The items of a section. Those of all sections but "bodies" are read with the names of bodies.
template <class Item, class Read, class... Names>
void read_items(const JsonValue& root, std::string_view section, std::vector<Item>& items,
                const Definitions& definitions, std::vector<std::size_t>& calling, Read read, const Names&... bodies) {
  const std::optional<JsonValue> list = root.optional(section);
  if (!list) return;
  const std::size_t size = list->size(fmt::format("an array of {}", section));
  for (std::size_t k = 0; k < size; ++k) {
    const int before = definitions.asked();
    items.push_back(read(list->at(k), bodies...));
    if (definitions.asked() > before) calling.push_back(k);
  }
}

template <class Item, class Read, class... Names>
void read_items_again(const JsonValue& root, std::string_view section, std::vector<Item>& items,
                      const std::vector<std::size_t>& calling, Read read, const Names&... bodies) {
  if (calling.empty()) return;
  const JsonValue list = root.required(section);
  for (const std::size_t k : calling) items[k] = read(list.at(k), bodies...);
}

void set_values(Scene& scene, const Definitions& definitions, const ParameterValues& set) {
  scene.parameters.clear();
  for (const auto& [name, value] : definitions.values()) scene.parameters.push_back({name, value, set.contains(name)});
}

// All but the text that is the scene.
Scene read_document(const JsonDocument& document, std::string_view file, const ParameterValues& set,
                    CallingItems& calling) {
  Definitions definitions(document);
  const JsonValue root = document.root(&definitions);
  const JsonValue version = root.required("scene");
  constexpr std::string_view kVersion = "1, the version of the format";
  if (version.is_string() || version.number(kVersion) != 1) version.expected(kVersion);

  if (const auto schema = root.optional("$schema")) (void)schema->string();  // for editors
  Scene scene;
  if (const auto name = root.optional("name")) scene.name = name->string();
  if (scene.name.empty()) scene.name = std::filesystem::path(file).filename().string();  // messages begin with it
  if (const auto about = root.optional("about")) scene.about = about->string();
  scene.gravity = optional_or(root, "gravity", read_vector, scene.gravity);

  (void)root.required("bodies");
  read_items(root, "bodies", scene.bodies, definitions, calling.bodies, read_body);
  in_file(file, [&] { validate_bodies(scene.bodies); });
  const BodyNames bodies(scene.bodies);
  read_items(root, "constraints", scene.constraints, definitions, calling.constraints, read_constraint, bodies);
  read_items(root, "joints", scene.joints, definitions, calling.joints, read_joint, bodies);
  read_items(root, "drivers", scene.drivers, definitions, calling.drivers, read_driver, bodies);
  read_items(root, "forces", scene.forces, definitions, calling.forces, read_force, bodies);
  in_file(file, [&] { validate(scene); });

  set_values(scene, definitions, set);
  scene.notices = definitions.unused();
  if (!root.optional("gravity") && !scene.joints.empty())
    scene.notices.push_back(
        "the scene has joints and says nothing of gravity, so there is none; \"gravity\": "
        "[0, 0, -9.81] is the earth's, [0, 0, 0] says that none is meant");
  return scene;
}

ParameterValues texts_of(const std::map<std::string, double>& values) {
  ParameterValues texts;
  for (const auto& [name, value] : values) texts.emplace(name, fmt::format("{}", value));
  return texts;
}

void require_read(const Scene& scene) {
  if (scene.source.empty()) throw InputError("with_parameters: found a scene that was not read, expected one that was");
}

}  // namespace

Scene parse_scene(std::string_view text, std::string_view file, const ParameterValues& set) {
  Scene scene;
  with_lines_of_errors(text, [&] {
    JsonDocument document(text, file);
    document.root().keys("a scene", {"$schema", "scene", "name", "about", "parameters", "tables", "gravity", "bodies",
                                     "constraints", "joints", "drivers", "forces"});
    const bool with_values = set_parameters(document, set);
    const bool with_files = load_tables(document, std::filesystem::path(file).parent_path());
    CallingItems none;  // are of interest
    scene = read_document(document, file, set, none);
    scene.source = with_values || with_files ? document.text() : std::string(text);
  });
  return scene;
}

Scene read_scene(const std::filesystem::path& file, const ParameterValues& set) {
  return parse_scene(read_text(file.string()), shown_input(file.string()), set);
}

Scene with_parameters(const Scene& scene, const std::map<std::string, double>& values) {
  VariedScene varied(scene);
  Scene with = varied.with(values);
  with.source = varied.source();
  return with;
}

VariedScene::VariedScene(const Scene& scene)
    : name_(printable(scene.name)), text_((require_read(scene), scene.source)), document_(text_, name_) {
  for (const Parameter& parameter : scene.parameters)
    if (parameter.set) set_.emplace(parameter.name, "");
}

const Scene& VariedScene::with(const std::map<std::string, double>& values) {
  with_lines_of_errors(text_, [&] {
    const ParameterValues set = texts_of(values);
    set_parameters(document_, set);
    set_.insert(set.begin(), set.end());
    if (scene_) return read_again();
    CallingItems calling;
    scene_ = read_document(document_, name_, set_, calling);
    calling_ = std::move(calling);
  });
  return *scene_;
}

void VariedScene::read_again() {
  Definitions definitions(document_);
  const JsonValue root = document_.root(&definitions);
  scene_->gravity = optional_or(root, "gravity", read_vector, scene_->gravity);
  read_items_again(root, "bodies", scene_->bodies, calling_.bodies, read_body);
  const BodyNames bodies(scene_->bodies);
  read_items_again(root, "constraints", scene_->constraints, calling_.constraints, read_constraint, bodies);
  read_items_again(root, "joints", scene_->joints, calling_.joints, read_joint, bodies);
  read_items_again(root, "drivers", scene_->drivers, calling_.drivers, read_driver, bodies);
  read_items_again(root, "forces", scene_->forces, calling_.forces, read_force, bodies);
  in_file(name_, [&] { validate_bodies(scene_->bodies), validate(*scene_); });
  set_values(*scene_, definitions, set_);
}

}  // namespace poinsot
