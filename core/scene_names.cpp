#include "core/scene_names.h"

#include <fmt/format.h>

namespace poinsot {

BodyNames::BodyNames(const std::vector<Body>& bodies) : bodies_(bodies) {
  numbers_.reserve(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) numbers_.emplace(bodies[k].name, static_cast<int>(k));
}

int BodyNames::number(const JsonValue& value, std::string_view allowed, std::string_view first) const {
  const std::string& name = value.string("the name of a body");
  if (name == "ground") return kGround;
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) value.expected(fmt::format("{}{}", allowed, after_colon(first, bodies_)));
  return found->second;
}

int BodyNames::read(const JsonValue& value) const {
  return number(value, "the name of a body", "ground");
}

int BodyNames::read_moving(const JsonValue& value) const {
  return number(value, "the name of a body that can move", "");
}

std::pair<int, int> BodyNames::read_pair(const JsonValue& value) const {
  constexpr std::string_view kAllowed = "an array of 2 names of bodies, i and j";
  if (value.size(kAllowed) != 2) value.expected(kAllowed);
  return {read(value.at(0)), read(value.at(1))};
}

std::string after_colon(std::string_view first, const std::vector<Body>& bodies) {
  constexpr std::size_t kShort = 12;
  if (bodies.size() > kShort) return "";
  std::string text(first);
  for (const Body& body : bodies) text += (text.empty() ? "" : ", ") + body.name;
  return text.empty() ? "" : ": " + text;
}

}  // namespace poinsot
