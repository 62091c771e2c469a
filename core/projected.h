// One thing of each of some items, in their order: the names in a table, the keys of a map.
#pragma once

#include <functional>
#include <iterator>
#include <type_traits>
#include <vector>

namespace poinsot {

// `of`: a member of an item, or a function of one.
template <class Items, class Of>
auto projected(const Items& items, Of of) {
  std::vector<std::decay_t<std::invoke_result_t<Of, decltype(*std::begin(items))>>> values;
  for (const auto& item : items) values.push_back(std::invoke(of, item));
  return values;
}

}  // namespace poinsot
