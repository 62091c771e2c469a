// What comes into a front (linsolve/block/schedule.h) before its elimination: its entries of the matrix and the update
// matrices of its children.
//
// Where the machine's vectors hold a whole column of a child's update and of each part of the front, the first child
// lays the front down: every column of D, L, U and W is one column of the update with its entries moved to their places
// and zeros between them. Otherwise the front is zeroed and the child added by stretches, as all other children are.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#include "linsolve/block/kernels.h"
#include "linsolve/block/schedule.h"

namespace poinsot::block {

// to[0 … n) += from[0 … n), n being small.
inline void add(double* to, const double* from, int n) {
  int i = 0;
  for (; i + kPair <= n; i += kPair) store_pair(to + i, load_pair(to + i) + load_pair(from + i));
  if (i < n) to[i] += from[i];
}

// Rows × columns numbers, a child's columns `from_step` apart, the parent's `to_step`. Rows are few: most by far are
// one to four, which are added without a loop.
template <int Rows>
inline void add_columns(double* to, int to_step, const double* from, int from_step, int columns) {
  for (; columns > 0; --columns, to += to_step, from += from_step) add(to, from, Rows);
}
inline void add_block(double* to, int to_step, const double* from, int from_step, int rows, int columns) {
  switch (rows) {
    case 1:
      return add_columns<1>(to, to_step, from, from_step, columns);
    case 2:
      return add_columns<2>(to, to_step, from, from_step, columns);
    case 3:
      return add_columns<3>(to, to_step, from, from_step, columns);
    case 4:
      return add_columns<4>(to, to_step, from, from_step, columns);
    default:
      for (; columns > 0; --columns, to += to_step, from += from_step) add(to, from, rows);
  }
}

// Adds a child's update matrix to the parent's D, L, U and W.
inline void extend_add(const Front& child, const double* update, const Stretch* stretches, const Front& parent,
                       double* front, double* W) {
  const int p = parent.pivots, rows = parent.rows;
  double *D = front + p * parent.others, *L = D + p * p, *U = front;
  const Stretch *first = stretches + child.first_stretch, *outer = stretches + child.first_outer_stretch,
                *last = stretches + child.last_stretch;
  for (const Stretch* across = first; across != last; ++across) {
    double* top = (across < outer ? D : U) + across->to * p;
    double* bottom = (across < outer ? L : W) + across->to * rows;
    const double* from = update + across->from * child.rows;
    for (const Stretch* down = first; down != outer; ++down)
      add_block(top + down->to, p, from + down->from, child.rows, down->length, across->length);
    for (const Stretch* down = outer; down != last; ++down)
      add_block(bottom + down->to, rows, from + down->from, child.rows, down->length, across->length);
  }
}

// By place in the front, pivots apart from the others: the child's unknown that goes there. Places without one take
// zeros.
struct Places {
  static constexpr std::uint8_t kNone = kLanes;
  std::uint8_t pivots[kLanes], others[kLanes];
};

inline bool lays_down(const Front& child, const Front& f) {
  return child.rows == kLanes && f.rows == kLanes && f.pivots <= kLanes;
}

inline Places places(const Front& child, const Stretch* stretches) {
  Places from;
  std::memset(&from, Places::kNone, sizeof from);
  for (int s = child.first_stretch; s < child.last_stretch; ++s) {
    const Stretch& stretch = stretches[s];
    std::uint8_t* to = (s < child.first_outer_stretch ? from.pivots : from.others) + stretch.to;
    for (int i = 0; i < stretch.length; ++i) to[i] = static_cast<std::uint8_t>(stretch.from + i);
  }
  return from;
}

// Moves the entries of a column to their places.
class Mover {
 public:
#if defined(__AVX512F__)
  explicit Mover(const std::uint8_t* from) {
    std::int64_t all;
    std::memcpy(&all, from, sizeof all);
    from_ = _mm512_cvtepu8_epi64(_mm_cvtsi64_si128(all));
    some_ = _mm512_cmpneq_epi64_mask(from_, _mm512_set1_epi64(Places::kNone));
  }
  Vec operator()(Vec x) const {
    return _mm512_maskz_permutexvar_pd(some_, from_, x);
  }

 private:
  __m512i from_;
  __mmask8 some_;
#else
  explicit Mover(const std::uint8_t* from) : from_(from) {}
  Vec operator()(Vec x) const {
    Vec y = {};
    for (int i = 0; i < kLanes; ++i)
      if (from_[i] != Places::kNone) y[i] = x[from_[i]];
    return y;
  }

 private:
  const std::uint8_t* from_;
#endif
};

// Columns are written in ascending order, each as a whole vector: what it has too many the next one takes back, and
// those of L have nothing too many.
inline void lay_down(const Places& from, const double* update, const Front& f, double* U, double* W) {
  const Mover top(from.pivots), bottom(from.others);
  static constexpr double kZeros[kLanes] = {};
  const auto column = [&](std::uint8_t k) { return load(k == Places::kNone ? kZeros : update + k * kLanes); };
  const int p = f.pivots, m = f.others;
  double *D = U + p * m, *L = D + p * p;
  for (int j = 0; j < m; ++j) {
    const Vec x = column(from.others[j]);
    store(U + j * p, top(x));
    store(W + j * kLanes, bottom(x));
  }
  for (int j = 0; j < p; ++j) store(D + j * p, top(column(from.pivots[j])));
  for (int j = 0; j < p; ++j) store(L + j * kLanes, bottom(column(from.pivots[j])));
}

template <int Length>
inline const Strip* add_strips(const Strip* strip, const Strip* end, const double* values, double* store) {
  for (; strip != end; ++strip) add(store + strip->target, values + strip->source, Length);
  return strip;
}

}  // namespace poinsot::block
