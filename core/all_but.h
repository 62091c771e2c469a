// Numbers left of a list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <vector>

namespace poinsot {

// The numbers below `count` that are not among `some`; both ascending.
inline std::vector<int> all_but(std::size_t count, const std::vector<int>& some) {
  std::vector<int> all(count), others;
  std::iota(all.begin(), all.end(), 0);
  std::ranges::set_difference(all, some, std::back_inserter(others));
  return others;
}

}  // namespace poinsot
