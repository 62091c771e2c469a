// Numbers 0 … n − 1 waiting in line, each at a degree: the least degree goes first, of its numbers the least.
//
// Of low degrees, nearly all, each has one bit for every number and, above them, one for every 64 bits that are not all
// zero, and so on: a few words tell which is the first, where a heap of a million numbers asks for twenty places of
// memory.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "core/index.h"

namespace poinsot::block {

class LeastFirst {
 public:
  explicit LeastFirst(int n) : n_(index(n)), degree_(n_, -1) {}

  // Puts k in line, or elsewhere in it.
  void put(int k, int degree) {
    int& at = degree_[index(k)];
    if (at == degree) return;
    if (at >= kDegrees) beyond_.erase({at, k});
    if (at >= 0 && at < kDegrees) low_[index(at)].erase(index(k));
    at = degree;
    if (degree >= kDegrees) {
      beyond_.insert({degree, k});
      return;
    }
    if (low_[index(degree)].levels.empty()) low_[index(degree)].resize(n_);
    low_[index(degree)].insert(index(k));
    least_ = std::min(least_, index(degree));
  }
  // Takes the first out of the line; −1 where nobody waits.
  int take() {
    while (least_ < low_.size() && low_[least_].waiting == 0) ++least_;
    int first = -1;
    if (least_ < low_.size()) {
      first = static_cast<int>(low_[least_].first());
      low_[least_].erase(index(first));
    } else if (!beyond_.empty()) {
      first = beyond_.begin()->second;
      beyond_.erase(beyond_.begin());
    }
    if (first >= 0) degree_[index(first)] = -1;
    return first;
  }

 private:
  static constexpr int kDegrees = 128;

  struct Bits {
    std::vector<std::vector<std::uint64_t>> levels;  // the last is one word
    std::size_t waiting = 0;

    void resize(std::size_t n) {
      do levels.emplace_back(n = (n + 63) / 64, 0);
      while (n > 1);
    }
    void insert(std::size_t k) {
      ++waiting;
      for (auto& level : levels) {
        level[k / 64] |= std::uint64_t{1} << k % 64;
        k /= 64;
      }
    }
    void erase(std::size_t k) {
      --waiting;
      for (auto& level : levels) {
        if ((level[k / 64] &= ~(std::uint64_t{1} << k % 64)) != 0) return;
        k /= 64;
      }
    }
    std::size_t first() const {
      std::size_t k = 0;
      for (auto level = levels.rbegin(); level != levels.rend(); ++level)
        k = 64 * k + index(std::countr_zero((*level)[k]));
      return k;
    }
  };

  std::size_t n_, least_ = 0;
  std::vector<int> degree_;
  std::array<Bits, kDegrees> low_;
  std::set<std::pair<int, int>> beyond_;
};

}  // namespace poinsot::block
