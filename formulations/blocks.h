// The sink of a matrix's blocks.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "linsolve/linear_solver.h"

namespace poinsot {

// Records the places of a matrix's blocks, or writes their values: those of the first() block at its places, whatever
// they hold, and those that come to it by add(). One sink for both, so that what writes into it is compiled once.
// Values that no cache holds are fetched ahead.
struct Blocks {
  explicit Blocks(std::vector<Block>* recorded) : places(recorded), writes_alone(false) {}
  Blocks(std::span<const int> slots, std::span<double> of)
      : slot(slots.data()), values(of.data()), end(slots.data() + slots.size()) {
    constexpr std::size_t kCached = 1u << 17, kAhead = 64;  // numbers: 1 MB; columns of blocks
    writes_alone = of.size() <= kCached || slots.size() <= kAhead;
    if (!writes_alone) ahead = slot + kAhead;
  }
  bool places_only() const { return places != nullptr; }
  template <class Derived>
  void first(int row, int col, const Eigen::MatrixBase<Derived>& m) {
    each(row, col, m, [](double& value, double number) { value = number; });
  }
  template <class Derived>
  void add(int row, int col, const Eigen::MatrixBase<Derived>& m) {
    each(row, col, m, [](double& value, double number) { value += number; });
  }
  [[gnu::noinline]] void record(const Block& place) { places->push_back(place); }
  [[gnu::noinline]] void fetch(int columns) {
    for (; columns > 0 && ahead != end; --columns) __builtin_prefetch(values + *ahead++, 1);
    writes_alone = ahead == end;
  }

  std::vector<Block>* places = nullptr;  // null where values are written
  const int* slot = nullptr;
  double* values = nullptr;
  const int *end = nullptr, *ahead = nullptr;
  bool writes_alone = true;

 private:
  template <class Derived, class Write>
  void each(int row, int col, const Eigen::MatrixBase<Derived>& m, Write&& write) {
    constexpr int kRows = Derived::RowsAtCompileTime, kCols = Derived::ColsAtCompileTime;
    if (!writes_alone) [[unlikely]] {
      if (places_only()) return record({row, col, kRows, kCols});
      fetch(kCols);
    }
    for (Eigen::Index c = 0; c < kCols; ++c) {
      double* column = values + *slot++;
      for (Eigen::Index r = 0; r < kRows; ++r) write(column[r], m(r, c));
    }
  }
};

}  // namespace poinsot
