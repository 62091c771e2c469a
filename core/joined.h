// Numbers that are joined, two by two, to sets.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/index.h"

namespace poinsot {

class Joined {
 public:
  explicit Joined(std::size_t count) : before_(count) { std::iota(before_.begin(), before_.end(), 0); }

  // The least of k's set.
  int first_of(int k) {
    while (before_[index(k)] != k) k = before_[index(k)] = before_[index(before_[index(k)])];
    return k;
  }
  // Whether they were not joined before.
  bool join(int i, int j) {
    i = first_of(i), j = first_of(j);
    before_[index(std::max(i, j))] = std::min(i, j);
    return i != j;
  }

 private:
  std::vector<int> before_;  // one of its set before it, or itself
};

}  // namespace poinsot
