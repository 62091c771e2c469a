#include "core/scene_names.h"

#include <fmt/format.h>

#include <algorithm>

namespace poinsot {

std::string read_name(const JsonValue& value) {
  constexpr std::string_view kAllowed = "a name without control characters";
  const std::string& name = value.string(kAllowed);
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (name.empty() || std::ranges::any_of(name, control)) value.expected(kAllowed);
  return name;
}

void BodyNames::add(const JsonValue& value, int number) {
  const std::string name = read_name(value);
  if (name == "ground") value.fail("found \"ground\", which is body 0 and never listed, expected another name");
  const auto [entry, is_new] = numbers_.emplace(name, number);
  if (!is_new) {
    value.fail(
        fmt::format("found \"{}\", the name of /bodies/{} already, expected a name of its own", name, entry->second));
  }
  constexpr std::size_t kShort = 12;
  if (numbers_.size() <= kShort) {
    list_ += (list_.empty() ? "" : ", ") + name;
  } else {
    list_.clear();
  }
}

int BodyNames::read(const JsonValue& value) const {
  const std::string& name = value.string("the name of a body");
  if (name == "ground") return kGround;
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) value.expected("the name of a body" + (list_.empty() ? "" : ": ground, " + list_));
  return found->second;
}

int BodyNames::read_moving(const JsonValue& value) const {
  const std::string& name = value.string("the name of a body");
  const auto found = numbers_.find(name);  // the ground is not among them
  if (found == numbers_.end()) value.expected("the name of a body that can move" + (list_.empty() ? "" : ": " + list_));
  return found->second;
}

std::pair<int, int> BodyNames::read_pair(const JsonValue& value) const {
  constexpr std::string_view kAllowed = "an array of 2 names of bodies, i and j";
  if (value.size(kAllowed) != 2) value.expected(kAllowed);
  const JsonValue first = value.at(0), second = value.at(1);
  const int i = read(first), j = read(second);
  if (i == j) value.fail(fmt::format("found \"{}\" twice, expected two different bodies", first.string()));
  return {i, j};
}

std::string ItemNames::next(const JsonValue& item, const std::string& type) {
  const int number = ++counts_[type];
  const std::optional<JsonValue> given = item.optional("name");
  std::string name = given ? read_name(*given) : fmt::format("{}{}", type, number);
  const JsonValue& place = given ? *given : item;
  const auto [entry, is_new] = taken_.emplace(name, "");
  if (!is_new) {
    place.fail(fmt::format("found \"{}\"{}, the name of {} already, expected a name of its own", name,
                           given ? "" : " (its name by type and number)", entry->second));
  }
  entry->second = item.path();
  return name;
}

}  // namespace poinsot
