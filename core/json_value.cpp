#include "core/json_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/counted.h"
#include "core/expression.h"
#include "core/input_error.h"
#include "core/printable.h"

namespace poinsot {

std::string describe(const nlohmann::json& value) {
  constexpr std::size_t kLongest = 60;
  if (value.is_object()) return "an object";
  if (value.is_array()) return "an array of " + counted(value.size(), "value");
  std::string text = value.dump();
  if (text.size() > kLongest) {
    std::size_t end = kLongest;
    while ((static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a UTF-8 sequence
    text = text.substr(0, end) + "...";
  }
  return printable(text);
}

std::string pointer_token(std::string_view key) {
  return (nlohmann::json::json_pointer() / printable(key)).to_string().substr(1);  // behind its '/'
}

std::string JsonValue::path() const {
  if (parent_ == nullptr) return "/";
  const std::string own = parent_->value_->is_array() ? fmt::format("{}", index_) : pointer_token(key_);
  return (parent_->parent_ == nullptr ? "" : parent_->path()) + "/" + own;
}

void JsonValue::fail(std::string_view message) const {
  throw ElementError(fmt::format("{}: {}: {}", file_, path(), message), path());
}

void JsonValue::expected(std::string_view allowed) const {
  fail(fmt::format("found {}, expected {}", describe(*value_), allowed));
}

void JsonValue::keys(std::string_view owner, std::span<const std::string_view> allowed) const {
  if (!value_->is_object()) expected(fmt::format("{} as an object", owner));
  for (const auto& [key, value] : value_->items()) {
    if (std::ranges::find(allowed, key) == allowed.end()) {
      JsonValue(value, *this, key, 0)
          .fail(fmt::format("unknown key, expected for {}: {}", owner, fmt::join(allowed, ", ")));
    }
  }
}

std::optional<JsonValue> JsonValue::optional(std::string_view key) const& {
  if (!value_->is_object()) expected("an object");
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return JsonValue(*found, *this, found.key(), 0);
}

JsonValue JsonValue::required(std::string_view key) const& {
  const std::optional<JsonValue> found = optional(key);
  if (!found) JsonValue(*value_, *this, key, 0).fail("found nothing, the key is required");
  return *found;
}

std::size_t JsonValue::size(std::string_view allowed) const {
  if (!value_->is_array()) expected(allowed);
  return value_->size();
}

JsonValue JsonValue::at(std::size_t index) const& {
  return JsonValue((*value_)[index], *this, {}, index);
}

std::vector<std::string> JsonValue::names(std::string_view allowed) const {
  if (!value_->is_object()) expected(allowed);
  std::vector<std::string> names;
  for (const auto& [key, value] : value_->items()) names.push_back(key);
  return names;
}

bool JsonValue::is_array() const {
  return value_->is_array();
}

bool JsonValue::is_string() const {
  return value_->is_string();
}

const std::string& JsonValue::string(std::string_view allowed) const {
  if (!value_->is_string()) expected(allowed);
  return value_->get_ref<const std::string&>();
}

bool JsonValue::boolean(std::string_view allowed) const {
  if (!value_->is_boolean()) expected(allowed);
  return value_->get<bool>();
}

double JsonValue::number(std::string_view allowed) const {
  if (value_->is_number()) return value_->get<double>();  // finite: the parser refuses numbers out of range
  if (!value_->is_string()) expected(allowed);
  try {
    return Expression::parse_constant(value_->get_ref<const std::string&>(), names_).at(0.0).f;
  } catch (const ExpressionError& error) {
    fail(fmt::format("found {} ({}), expected {}", describe(*value_), error.what(), allowed));
  }
}

}  // namespace poinsot
