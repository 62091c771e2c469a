// Many short lists of numbers in one piece of memory: list k has the items item[start[k]] … item[start[k+1]−1].
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace poinsot {

class Lists {
 public:
  Lists() = default;

  // visit(emit) calls emit(list, item) for every item, the same ones each of the two times it is called. In a list
  // items are sorted, each once.
  template <class Visit>
  static Lists collect(int lists, Visit&& visit) {
    Lists all;
    all.start_.assign(at(lists) + 1, 0);
    visit([&](int list, int) { ++all.start_[at(list) + 1]; });
    for (std::size_t k = 1; k < all.start_.size(); ++k) all.start_[k] += all.start_[k - 1];
    std::vector<int> next(all.start_.begin(), all.start_.end() - 1);
    all.item_.resize(at(all.start_.back()));
    visit([&](int list, int item) { all.item_[at(next[at(list)]++)] = item; });
    int kept = 0;
    for (std::size_t k = 0; k + 1 < all.start_.size(); ++k) {
      const auto first = all.item_.begin() + all.start_[k], last = all.item_.begin() + all.start_[k + 1];
      std::sort(first, last);
      all.start_[k] = kept;
      kept = static_cast<int>(std::unique_copy(first, last, all.item_.begin() + kept) - all.item_.begin());
    }
    all.start_.back() = kept;
    all.item_.resize(at(kept));
    return all;
  }

  int size() const { return static_cast<int>(start_.size()) - 1; }
  std::span<const int> operator[](int k) const {
    return {item_.data() + start_[at(k)], at(start_[at(k) + 1] - start_[at(k)])};
  }

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  std::vector<int> start_{0}, item_;
};

}  // namespace poinsot
