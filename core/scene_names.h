// Who is called what in a scene: bodies by name, and the names of constraints, joints, drivers and forces.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "core/json_value.h"
#include "core/scene.h"
#include "core/scene_types.h"

namespace poinsot {

// The bodies of a scene by name, as a scene file refers to them. Of two with one name the first is found.
class BodyNames {
 public:
  explicit BodyNames(const std::vector<Body>& bodies);  // which stay while this is used

  int read(const JsonValue& value) const;                       // a body; the ground too
  int read_moving(const JsonValue& value) const;                // a body; the ground is for validate() to refuse
  std::pair<int, int> read_pair(const JsonValue& value) const;  // [i, j]

 private:
  int number(const JsonValue& value, std::string_view allowed, std::string_view first) const;

  const std::vector<Body>& bodies_;
  std::unordered_map<std::string_view, int> numbers_;
};

// ": ground, a, b", what `first` and the bodies are called, for messages; empty where there are many of them.
std::string after_colon(std::string_view first, const std::vector<Body>& bodies);

// Of a constraint, a joint, a driver or a force: the name as the scene gives it, empty where it does not.
template <class Item>
const std::string& given_name(const Item& item) {
  return item.name;
}
inline const std::string& given_name(const Force& force) {
  return std::visit([](const auto& f) -> const std::string& { return f.name; }, force);
}

// Of these, as a scene file writes it.
template <class Item>
const char* type_of(const Item& item) {
  return type_name(item.type);
}
inline const char* type_of(const Force& force) {
  return type_name(force);
}

// What has no name is called by its type and number: the third revolute joint is "revolute3".
class ItemNames {
 public:
  // The name of the next item.
  template <class Item>
  std::string next(const Item& item) {
    const char* type = type_of(item);
    const int number = ++counts_[type];
    const std::string& given = given_name(item);
    return given.empty() ? type + std::to_string(number) : given;
  }

 private:
  std::map<std::string_view, int> counts_;  // by type
};

}  // namespace poinsot
