// A place in a parsed JSON document: the value, and the key path by which errors speak of it ("/bodies/2/mass").
//
// Everything read through it is checked, and nothing is converted: what does not fit is an InputError that says
//   FILE: PATH: found WHAT, expected WHAT IS ALLOWED
// A place refers to the place it was reached from (paths are put together only when an error needs one), so that place
// has to be a variable that lives on; the compiler refuses temporaries.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace poinsot {

class ExpressionNames;

class JsonValue {
 public:
  // `names`: what the expressions in it may call by name, beside the names of the language.
  JsonValue(const nlohmann::json& value, std::string_view file, ExpressionNames* names = nullptr)
      : value_(&value), file_(file), names_(names) {}

  // The same place, for a value that follows from the one here.
  JsonValue holding(const nlohmann::json& value) const {
    JsonValue other = *this;
    other.value_ = &value;
    return other;
  }

  std::string path() const;  // a JSON pointer; "/" for the document itself
  [[noreturn]] void fail(std::string_view message) const;
  [[noreturn]] void expected(std::string_view allowed) const;  // "found ..., expected {allowed}"

  // Objects. keys() comes first: it refuses what is not an object and every key not listed. `owner` is whose keys they
  // are: "a body", "a DP1".
  void keys(std::string_view owner, std::span<const std::string_view> allowed) const;
  void keys(std::string_view owner, std::initializer_list<std::string_view> allowed) const {
    keys(owner, std::span(allowed.begin(), allowed.size()));
  }
  JsonValue required(std::string_view key) const&;
  std::optional<JsonValue> optional(std::string_view key) const&;
  JsonValue required(std::string_view key) const&& = delete;
  std::optional<JsonValue> optional(std::string_view key) const&& = delete;

  std::vector<std::string> names(std::string_view allowed) const;  // the keys of an object, sorted

  // Arrays. `allowed` is what errors say is allowed: "an array of bodies".
  std::size_t size(std::string_view allowed) const;
  JsonValue at(std::size_t index) const&;
  JsonValue at(std::size_t index) const&& = delete;

  bool is_array() const;
  bool is_string() const;
  const std::string& string(std::string_view allowed = "a string") const;
  bool boolean(std::string_view allowed = "true or false") const;
  // A number, or a string holding a constant expression; always finite.
  double number(std::string_view allowed = "a number") const;
  ExpressionNames* expression_names() const { return names_; }

 private:
  JsonValue(const nlohmann::json& value, const JsonValue& parent, std::string_view key, std::size_t index)
      : value_(&value), parent_(&parent), key_(key), index_(index), file_(parent.file_), names_(parent.names_) {}

  const nlohmann::json* value_;
  const JsonValue* parent_ = nullptr;
  std::string_view key_;   // in an object
  std::size_t index_ = 0;  // in an array
  std::string_view file_;
  ExpressionNames* names_;
};

// What was found, in a few words, for messages: short values as they stand, the others by kind.
std::string describe(const nlohmann::json& value);

// The token of a JSON pointer (RFC 6901) for a key, as messages show it.
std::string pointer_token(std::string_view key);

}  // namespace poinsot
