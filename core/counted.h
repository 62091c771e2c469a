// Counts in sentences: "1 body", "2 bodies".
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace poinsot {

// `many`: where it is not `one` with an s.
template <class Count>
std::string counted(Count n, std::string_view one, std::string_view many = {}) {
  if (n == 1) return fmt::format("1 {}", one);
  return many.empty() ? fmt::format("{} {}s", n, one) : fmt::format("{} {}", n, many);
}

}  // namespace poinsot
