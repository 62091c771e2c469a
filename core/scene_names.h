// Who is called what in a scene: bodies by name, and the names of constraints, joints, drivers and forces.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/json_value.h"
#include "core/scene.h"

namespace poinsot {

// A name heads columns and stands in messages: not empty, no control characters.
std::string read_name(const JsonValue& value);

class BodyNames {
 public:
  void add(const JsonValue& name, int number);                  // refuses "ground" and what is taken
  int read(const JsonValue& value) const;                       // a body; the ground too
  int read_moving(const JsonValue& value) const;                // a body, not the ground
  std::pair<int, int> read_pair(const JsonValue& value) const;  // two different ones: [i, j]

 private:
  std::unordered_map<std::string, int> numbers_;
  std::string list_;  // "a, b, c", while it is short
};

// Names that may come once. What has none is called by its type and number: the third revolute joint is "revolute3".
class ItemNames {
 public:
  // The name of the object, which is the next one of its type.
  std::string next(const JsonValue& item, const std::string& type);

 private:
  std::map<std::string, int> counts_;                   // by type
  std::unordered_map<std::string, std::string> taken_;  // name → where
};

}  // namespace poinsot
