// Dense operations on one front (linsolve/block/schedule.h), for a number of pivots P fixed at compile time.
//
//   eliminate:  P_r D = L_D U_D with pivoting inside the block,  U ← P_r U,  L ← L (L_D U_D)⁻¹,  W ← W − L U
//   forward:    b₁ ← P_r b₁,  b₂ ← b₂ − L b₁
//   backward:   b₁ ← (L_D U_D)⁻¹ (b₁ − U b₂)
//
// Why not Eigen's LU of fixed size: linsolve/dense_kernels.h has the figures.
//
// The diagonal of U_D is stored inverted. P = 0 stands for a number known at run time only. Rows go by whole vectors:
// the padding rows of L and W are zero and stay so.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "linsolve/block/schedule.h"
#include "linsolve/lanes.h"

namespace poinsot::block {

// As load, of numbers that were just written one by one or in other groups: a processor hands a store on to a later
// load only where the store holds all of it.
inline Vec gather(const double* x) {
  Vec v;
  for (int i = 0; i < kLanes; ++i) v[i] = x[i];
  return v;
}

// Two numbers at a time, for short runs.
inline constexpr int kPair = 2;
typedef double Pair __attribute__((vector_size(kPair * sizeof(double))));
inline Pair load_pair(const double* x) {
  Pair v;
  std::memcpy(&v, x, sizeof v);
  return v;
}
inline void store_pair(double* x, Pair v) {
  std::memcpy(x, &v, sizeof v);
}

// A candidate this many times larger than the diagonal takes its place where pivots are chosen; where an order chosen
// before is kept, its pivots may fall behind as much more again.
inline constexpr double kReluctance = 10;

// How far pivots are from those of a factorization that was examined, in the units of their rows, which may have
// changed places: the least and the largest |u| / |u then|.
struct Drift {
  double least = 1, largest = 1, poison = 0;  // poison is 0 while all pivots are numbers

  void add(double ratio) {
    least = std::min(least, ratio);
    largest = std::max(largest, ratio);
    poison += ratio * 0;
  }
};

// D ← its factors, p × p, with its rows in the given order (null: as they are), in straight-line code. False, and D as
// it was, where a candidate is more than `reluctance` times a pivot, in the units of rows given by `weight`. `then`
// holds 1/|pivot| in these units for Drift. Flattened, or the compiler leaves parts of it as calls, with all numbers
// through memory.
template <int P>
[[gnu::flatten]] inline bool factor_in_order(double* D, const std::uint16_t* order, const float* weight,
                                             double reluctance, const float* then, Drift& drift) {
  double a[P * P], unit[P];
  if (order) {
    unrolled<P>([&](auto i) {
      const int row = order[i];
      unit[i] = weight[row];
      unrolled<P>([&](auto k) { a[k * P + i] = D[k * P + row]; });
    });
  } else {
    unrolled<P * P>([&](auto k) { a[k] = D[k]; });
    unrolled<P>([&](auto i) { unit[i] = weight[i]; });
  }
  double excess = 0;
  Drift seen = drift;
  unrolled<P>([&](auto k) {
    double largest = 0;
    unrolled<P>([&](auto i) {
      if constexpr (i > k) largest = std::max(largest, std::abs(a[k * P + i]) * unit[i]);
    });
    excess = std::max(excess, largest - reluctance * std::abs(a[k * P + k]) * unit[k]);
    seen.add(std::abs(a[k * P + k]) * unit[k] * then[k]);
    const double inverse = 1 / a[k * P + k];
    a[k * P + k] = inverse;
    unrolled<P>([&](auto i) {
      if constexpr (i > k) a[k * P + i] *= inverse;
    });
    unrolled<P>([&](auto j) {
      if constexpr (j > k)
        unrolled<P>([&](auto i) {
          if constexpr (i > k) a[j * P + i] -= a[k * P + i] * a[j * P + k];
        });
    });
  });
  if (!(excess <= 0)) return false;
  drift = seen;
  unrolled<P * P>([&](auto k) { D[k] = a[k]; });
  return true;
}

// The same with the order chosen here: the diagonal while it serves, so that kept orders and pivots stay comparable.
// True where rows moved. `unit` has room for p numbers.
inline bool factor_choosing(double* D, int p, std::uint16_t* order, const float* weight, double* unit,
                            const float* then, Drift& drift) {
  bool moved = false;
  for (int i = 0; i < p; ++i) order[i] = static_cast<std::uint16_t>(i), unit[i] = weight[i];
  for (int k = 0; k < p; ++k) {
    double* column = D + k * p;
    int best = k;
    double largest = 0;
    for (int i = k + 1; i < p; ++i) largest = std::max(largest, std::abs(column[i]) * unit[i]);
    if (largest > kReluctance * std::abs(column[k]) * unit[k]) {
      while (std::abs(column[best]) * unit[best] != largest) ++best;
      for (int j = 0; j < p; ++j) std::swap(D[j * p + k], D[j * p + best]);
      std::swap(unit[k], unit[best]);
      std::swap(order[k], order[best]);
      moved = true;
    }
    drift.add(std::abs(column[k]) * unit[k] * then[k]);
    const double inverse = 1 / column[k];
    column[k] = inverse;
    for (int i = k + 1; i < p; ++i) column[i] *= inverse;
    for (int j = k + 1; j < p; ++j) {
      const double u = D[j * p + k];
      for (int i = k + 1; i < p; ++i) D[j * p + i] -= column[i] * u;
    }
  }
  return moved;
}

// x ← x in the given order; `scratch` has room for p numbers, which no fixed P needs.
template <int P>
inline void reorder(const std::uint16_t* order, int p, double* x, double* scratch) {
  if constexpr (P > 0) {
    double y[P];
    unrolled<P>([&](auto k) { y[k] = x[order[k]]; });
    unrolled<P>([&](auto k) { x[k] = y[k]; });
  } else {
    for (int k = 0; k < p; ++k) scratch[k] = x[order[k]];
    std::copy_n(scratch, p, x);
  }
}

// L ← L (L_D U_D)⁻¹ for C vectors of rows from `row` on, kept in registers, and with them `out` ← W − L U.
template <int P, int C>
inline void eliminate_rows(const double* D, double* L, const double* U, const double* W, double* out, int m, int rows,
                           int row) {
  Vec x[P][C];
  L += row, W += row, out += row;
  unrolled<P>([&](auto k) {
    unrolled<C>([&](auto c) { x[k][c] = gather(L + k * rows + c * kLanes); });
    unrolled<P>([&](auto j) {
      if constexpr (j < k) unrolled<C>([&](auto c) { x[k][c] -= x[j][c] * D[k * P + j]; });
    });
    unrolled<C>([&](auto c) { x[k][c] *= D[k * P + k]; });
  });
  unrolled<P>([&](auto back) {
    constexpr int k = P - 1 - back;
    unrolled<P>([&](auto j) {
      if constexpr (j > k) unrolled<C>([&](auto c) { x[k][c] -= x[j][c] * D[k * P + j]; });
    });
    unrolled<C>([&](auto c) { store(L + k * rows + c * kLanes, x[k][c]); });
  });
  for (int j = 0; j < m; ++j, W += rows, out += rows, U += P) {
    Vec w[C];
    unrolled<C>([&](auto c) { w[c] = gather(W + c * kLanes); });
    unrolled<P>([&](auto k) { unrolled<C>([&](auto c) { w[c] -= x[k][c] * U[k]; }); });
    unrolled<C>([&](auto c) { store(out + c * kLanes, w[c]); });
  }
}

// How a front's pivots are chosen: `order` is that of its rows, `moved` tells whether it is another than 0, 1, 2, …
struct Choice {
  std::uint16_t* order;
  const float* weight;
  const float* then;
  bool moved;
  bool keep;  // the order of the last factorization, while it serves
};

// `scratch` has room for p numbers.
template <int P>
void eliminate(double* D, const Front& f, const double* W, double* out, Choice& choice, double* scratch, Drift& drift) {
  const int p = P ? P : f.pivots, m = f.others, rows = f.rows;
  double *L = D + p * p, *U = L + p * rows;
  bool done = false;
  if constexpr (P > 0) {
    if (!choice.keep) choice.moved = false;
    done = factor_in_order<P>(D, choice.moved ? choice.order : nullptr, choice.weight,
                              choice.keep ? kReluctance * kReluctance : kReluctance, choice.then, drift);
  }
  if (!done) choice.moved = factor_choosing(D, p, choice.order, choice.weight, scratch, choice.then, drift);
  if (choice.moved)
    for (int j = 0; j < m; ++j) reorder<P>(choice.order, p, U + j * p, scratch);
  if constexpr (P > 0) {
    // As many rows at once as leave room in the registers.
    constexpr int kTogether = P <= 6 ? 2 : 1;
    int row = 0;
    for (; row + kTogether * kLanes <= rows; row += kTogether * kLanes)
      eliminate_rows<P, kTogether>(D, L, U, W, out, m, rows, row);
    if constexpr (kTogether > 1)
      if (row < rows) eliminate_rows<P, 1>(D, L, U, W, out, m, rows, row);
  } else {
    for (int k = 0; k < p; ++k) {
      double* x = L + k * rows;
      for (int j = 0; j < k; ++j) {
        const double u = D[k * p + j];
        const double* y = L + j * rows;
        for (int i = 0; i < rows; ++i) x[i] -= y[i] * u;
      }
      for (int i = 0; i < rows; ++i) x[i] *= D[k * p + k];
    }
    for (int k = p - 1; k >= 0; --k)
      for (int j = k + 1; j < p; ++j) {
        const double l = D[k * p + j];
        double* x = L + k * rows;
        const double* y = L + j * rows;
        for (int i = 0; i < rows; ++i) x[i] -= y[i] * l;
      }
    std::copy_n(W, m * rows, out);
    for (int j = 0; j < m; ++j)
      for (int k = 0; k < p; ++k) {
        const double u = U[j * p + k];
        const double* y = L + k * rows;
        for (int i = 0; i < rows; ++i) out[j * rows + i] -= y[i] * u;
      }
  }
}

// What a solve passes over: the factors, the unknowns of its fronts (Schedule), the right-hand side by unknown, and
// room for `rows` and p numbers.
struct Pass {
  const double* store;
  const int *unknown, *other;
  double *x, *t;
};

// `order` is null where no rows moved.
template <int P>
[[gnu::flatten]] void forward(const Pass& pass, const Front& f, const std::uint16_t* order) {
  const int p = P ? P : f.pivots, rows = f.rows;
  const double* L = pass.store + f.store + p * p;
  const int *own = pass.unknown + f.first, *other = pass.other + f.list;
  double *x = pass.x, *t = pass.t;
  if constexpr (P > 0) {
    double b[P];
    unrolled<P>([&](auto k) { b[k] = x[own[k]]; });
    if (order) {
      reorder<P>(order, p, b, t);
      unrolled<P>([&](auto k) { x[own[k]] = b[k]; });
    }
    for (int row = 0; row < rows; row += kLanes) {
      Vec sum = load(L + row) * b[0];
      unrolled<P>([&](auto k) {
        if constexpr (k > 0) sum += load(L + k * rows + row) * b[k];
      });
      unrolled<kLanes>([&](auto i) { x[other[row + i]] -= sum[i.value]; });
    }
  } else {
    double* b = t + rows;
    for (int k = 0; k < p; ++k) b[k] = x[own[order ? order[k] : k]];
    for (int k = 0; k < p; ++k) x[own[k]] = b[k];
    std::fill_n(t, rows, 0.0);
    for (int k = 0; k < p; ++k)
      for (int i = 0; i < rows; ++i) t[i] += L[k * rows + i] * b[k];
    for (int i = 0; i < f.others; ++i) x[other[i]] -= t[i];
  }
}

// Columns of U are loaded as whole vectors: what follows a column comes along and is not used.
template <int P>
[[gnu::flatten]] void backward(const Pass& pass, const Front& f) {
  const int p = P ? P : f.pivots;
  const double *D = pass.store + f.store, *U = D + p * (p + f.rows);
  const int *own = pass.unknown + f.first, *other = pass.other + f.list, *end = other + f.others;
  double *x = pass.x, *t = pass.t;
  if constexpr (P > 0) {
    constexpr int C = padded(P) / kLanes;
    Vec sum[C] = {};
    unrolled<P>([&](auto k) { sum[k.value / kLanes][k.value % kLanes] = x[own[k]]; });
    const auto take = [&](const double* column, double xj) {
      unrolled<C>([&](auto c) { sum[c] -= load(column + c * kLanes) * xj; });
    };
    for (; end - other >= 2; other += 2, U += 2 * P) {
      take(U, x[other[0]]);
      take(U + P, x[other[1]]);
    }
    if (other != end) take(U, x[*other]);
    double b[P];
    unrolled<P>([&](auto k) { b[k] = sum[k.value / kLanes][k.value % kLanes]; });
    unrolled<P>([&](auto k) {
      unrolled<P>([&](auto i) {
        if constexpr (i > k) b[i] -= D[k * P + i] * b[k];
      });
    });
    unrolled<P>([&](auto back) {
      constexpr int k = P - 1 - back;
      b[k] *= D[k * P + k];
      unrolled<P>([&](auto i) {
        if constexpr (i < k) b[i] -= D[k * P + i] * b[k];
      });
    });
    unrolled<P>([&](auto k) { x[own[k]] = b[k]; });
  } else {
    for (int k = 0; k < p; ++k) t[k] = x[own[k]];
    for (; other != end; ++other, U += p)
      for (int k = 0; k < p; ++k) t[k] -= U[k] * x[*other];
    for (int k = 0; k < p; ++k)
      for (int i = k + 1; i < p; ++i) t[i] -= D[k * p + i] * t[k];
    for (int k = p - 1; k >= 0; --k) {
      t[k] *= D[k * p + k];
      for (int i = 0; i < k; ++i) t[i] -= D[k * p + i] * t[k];
    }
    for (int k = 0; k < p; ++k) x[own[k]] = t[k];
  }
}

}  // namespace poinsot::block
