// An index or a count, which this code keeps as a signed number, for the standard library's containers, which want it
// unsigned.
#pragma once

#include <cstddef>
#include <cstdint>

namespace poinsot {

constexpr std::size_t index(std::int64_t k) {
  return static_cast<std::size_t>(k);
}

}  // namespace poinsot
