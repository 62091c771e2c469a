// Many short lists of numbers in one piece of memory: list k has the items item[start[k]] … item[start[k+1]−1].
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/index.h"

namespace poinsot {

class Lists {
 public:
  Lists() = default;

  // visit(emit) calls emit(list, item) for every item, the same ones each of the two times it is called. In a list
  // items are sorted, each once.
  template <class Visit>
  static Lists collect(int lists, Visit&& visit) {
    Lists all;
    all.start_.assign(index(lists) + 1, 0);
    visit([&](int list, int) { ++all.start_[index(list) + 1]; });
    for (std::size_t k = 1; k < all.start_.size(); ++k) all.start_[k] += all.start_[k - 1];
    std::vector<int> next(all.start_.begin(), all.start_.end() - 1);
    all.item_.resize(index(all.start_.back()));
    visit([&](int list, int item) { all.item_[index(next[index(list)]++)] = item; });
    int kept = 0;
    for (std::size_t k = 0; k + 1 < all.start_.size(); ++k) {
      const auto first = all.item_.begin() + all.start_[k], last = all.item_.begin() + all.start_[k + 1];
      std::sort(first, last);
      all.start_[k] = kept;
      kept = static_cast<int>(std::unique_copy(first, last, all.item_.begin() + kept) - all.item_.begin());
    }
    all.start_.back() = kept;
    all.item_.resize(index(kept));
    return all;
  }

  int size() const { return static_cast<int>(start_.size()) - 1; }
  std::span<const int> operator[](int k) const {
    return {item_.data() + start_[index(k)], index(start_[index(k) + 1] - start_[index(k)])};
  }

 private:
  std::vector<int> start_{0}, item_;
};

}  // namespace poinsot
