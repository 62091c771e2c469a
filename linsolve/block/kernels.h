// Dense operations on one front (linsolve/block/schedule.h), for a number of pivots P fixed at compile time.
//
//   eliminate:  D is factored or inverted with pivoting inside the block (pivots.h),  U ← P_r U,  L ← L (P_r D)⁻¹,
//               W ← W − L U
//   forward:    b₁ ← P_r b₁,  b₂ ← b₂ − L b₁
//   backward:   b₁ ← (P_r D)⁻¹ (b₁ − U b₂)
//
// Why not Eigen's LU of fixed size: linsolve/dense_kernels.h has the figures.
//
// P = 0 stands for a number known at run time only. Rows go by whole vectors: the padding rows of L and W are zero and
// stay so.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "linsolve/block/pivots.h"
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

// L ← L (P_r D)⁻¹ for C vectors of rows from `row` on, kept in registers, and with them `out` ← W − L U. Whole: D is
// inverted, not factored.
template <int P, int C, bool Whole>
inline void eliminate_rows(const double* D, double* L, const double* U, const double* W, double* out, int m, int rows,
                           int row) {
  Vec x[P][C];
  L += row, W += row, out += row;
  if constexpr (Whole) {
    Vec l[P][C];
    unrolled<P>([&](auto k) { unrolled<C>([&](auto c) { l[k][c] = gather(L + k * rows + c * kLanes); }); });
    unrolled<P>([&](auto k) {
      unrolled<C>([&](auto c) {
        x[k][c] = l[0][c] * D[k * P];
        unrolled<P>([&](auto j) {
          if constexpr (j > 0) x[k][c] += l[j][c] * D[k * P + j];
        });
      });
    });
  } else {
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
    });
  }
  unrolled<P>([&](auto k) { unrolled<C>([&](auto c) { store(L + k * rows + c * kLanes, x[k][c]); }); });
  for (int j = 0; j < m; ++j, W += rows, out += rows, U += P) {
    Vec w[C];
    unrolled<C>([&](auto c) { w[c] = gather(W + c * kLanes); });
    unrolled<P>([&](auto k) { unrolled<C>([&](auto c) { w[c] -= x[k][c] * U[k]; }); });
    unrolled<C>([&](auto c) { store(out + c * kLanes, w[c]); });
  }
}

// `scratch` has room for p numbers.
template <int P>
void eliminate(double* U, const Front& f, const double* W, double* out, Choice& choice, double* scratch, Drift& drift) {
  const int p = P ? P : f.pivots, m = f.others, rows = f.rows;
  double *D = U + p * m, *L = D + p * p;
  bool done = false;
  if constexpr (P > 0) {
    if (!choice.keep) choose(D, P, choice);
    constexpr double kBehind = kReluctance * kReluctance;
    done = choice.whole ? invert_in_order<P>(D, choice, kBehind, drift) : factor_in_order<P>(D, choice, kBehind, drift);
  }
  if (!done) {
    choice.whole = false;
    factor_choosing(D, p, choice, scratch, drift);
  }
  if (choice.moved)
    for (int j = 0; j < m; ++j) reorder<P>(choice.order, p, U + j * p, scratch);
  if constexpr (P > 0) {
    // As many rows at once as leave room in the registers.
    constexpr int kTogether = P <= 6 ? 2 : 1;
    const auto all_rows = [&](auto whole) {
      int row = 0;
      for (; row + kTogether * kLanes <= rows; row += kTogether * kLanes)
        eliminate_rows<P, kTogether, whole>(D, L, U, W, out, m, rows, row);
      if constexpr (kTogether > 1)
        if (row < rows) eliminate_rows<P, 1, whole>(D, L, U, W, out, m, rows, row);
    };
    if (choice.whole)
      all_rows(std::true_type());
    else
      all_rows(std::false_type());
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

// What a solve passes over: the factors, the positions of its fronts' others and the unknowns at all positions
// (Schedule), the right-hand side by position, where the solution goes by unknown, and room for `rows` and p numbers.
struct Pass {
  const int *unknown, *other;
  double *y, *x, *t;
};

// Moved: rows are in another order than 0, 1, 2, …, in this one.
template <int P, bool Moved>
[[gnu::flatten]] void forward(const Pass& pass, const Front& f, const double* L, const std::uint16_t* order) {
  const int p = P ? P : f.pivots, rows = f.rows;
  const int* other = pass.other + f.list;
  double *y = pass.y, *own = y + f.first, *t = pass.t;
  if constexpr (P > 0) {
    double b[P];
    unrolled<P>([&](auto k) { b[k] = own[Moved ? order[k] : k.value]; });
    if constexpr (Moved) unrolled<P>([&](auto k) { own[k] = b[k]; });
    for (int row = 0; row < rows; row += kLanes) {
      Vec sum = load(L + row) * b[0];
      unrolled<P>([&](auto k) {
        if constexpr (k > 0) sum += load(L + k * rows + row) * b[k];
      });
      unrolled<kLanes>([&](auto i) { y[other[row + i]] -= sum[i.value]; });
    }
  } else {
    double* b = t + rows;
    for (int k = 0; k < p; ++k) b[k] = own[Moved ? order[k] : k];
    std::copy_n(b, p, own);
    std::fill_n(t, rows, 0.0);
    for (int k = 0; k < p; ++k)
      for (int i = 0; i < rows; ++i) t[i] += L[k * rows + i] * b[k];
    for (int i = 0; i < f.others; ++i) y[other[i]] -= t[i];
  }
}

// Columns of U and D⁻¹, and right-hand sides, are loaded as whole vectors: what follows a column comes along and is not
// used.
template <int P, bool Whole>
[[gnu::flatten]] void backward(const Pass& pass, const Front& f, const double* U) {
  const int p = P ? P : f.pivots;
  const double* D = U + p * f.others;
  const int *unknown = pass.unknown + f.first, *other = pass.other + f.list, *end = other + f.others;
  double *y = pass.y, *own = y + f.first, *t = pass.t;
  const auto give = [&](int k, double x) { own[k] = pass.x[unknown[k]] = x; };
  if constexpr (P > 0) {
    constexpr int C = padded(P) / kLanes;
    Vec sum[C];
    unrolled<C>([&](auto c) { sum[c] = load(own + c * kLanes); });
    const auto take = [&](const double* column, double xj) {
      unrolled<C>([&](auto c) { sum[c] -= load(column + c * kLanes) * xj; });
    };
    for (; end - other >= 2; other += 2, U += 2 * P) {
      take(U, y[other[0]]);
      take(U + P, y[other[1]]);
    }
    if (other != end) take(U, y[*other]);
    if constexpr (Whole) {
      Vec b[2][C];
      unrolled<P>([&](auto k) {
        const Vec by = spread<k % kLanes>(sum[k / kLanes]);
        unrolled<C>([&](auto c) { add_to_one_of_two<k>(b, c, load(D + k * P + c * kLanes) * by); });
      });
      if constexpr (P > 1) unrolled<C>([&](auto c) { b[0][c] += b[1][c]; });
      unrolled<P>([&](auto k) { give(k, b[0][k / kLanes][k % kLanes]); });
    } else {
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
      unrolled<P>([&](auto k) { give(k, b[k]); });
    }
  } else {
    std::copy_n(own, p, t);
    for (; other != end; ++other, U += p)
      for (int k = 0; k < p; ++k) t[k] -= U[k] * y[*other];
    substitute(D, p, 0, t);
    for (int k = 0; k < p; ++k) give(k, t[k]);
  }
}

}  // namespace poinsot::block
