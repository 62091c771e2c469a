// What every rule of core/scene_validation.h is made of: the place it speaks of, and the checks that several share.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "core/input_error.h"
#include "core/scene.h"
#include "core/scene_types.h"

namespace poinsot {

// An item of a section; its path is put together only where an error needs it.
struct Place {
  const char* section;
  std::size_t index = 0;

  std::string path() const { return fmt::format("/{}/{}", section, index); }
  [[noreturn]] void fail(std::string_view key, std::string_view message) const {
    const std::string place = fmt::format("{}{}{}", path(), key.empty() ? "" : "/", key);
    throw ElementError(fmt::format("{}: {}", place, message), place);
  }
};

namespace rules {

void finite(const Place& at, std::string_view key, double x);
void finite(const Place& at, std::string_view key, const Eigen::Ref<const Eigen::MatrixXd>& x);  // a vector, too
// Of functions of time, those that are constant: others may have poles, and a run that comes to one says so.
void finite(const Place& at, std::string_view key, const Expression& f);
void positive(const Place& at, std::string_view key, double x);
void direction(const Place& at, std::string_view key, const Vector3& x);  // not zero

// Without control characters, in UTF-8.
void name(const Place& at, const std::string& text);
// The name is that of `first`; `why`: how it came to be called so.
[[noreturn]] void already(const Place& at, std::string_view key, std::string_view name, std::string_view why,
                          const Place& first);

// Enumerations come from casts as well.
template <class Type>
void known(const Place& at, std::string_view key, Type type) {
  const auto& table = type_names(type);
  if (static_cast<std::size_t>(type) >= std::size(table)) {
    at.fail(key, fmt::format("found {}, expected {}", static_cast<int>(type), one_of(table)));
  }
}

}  // namespace rules
}  // namespace poinsot
