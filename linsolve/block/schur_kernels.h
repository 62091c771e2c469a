// The dense operations of an elimination of all bodies at once (linsolve/block/schur.h).
//
// For N constraints and U unknowns of bodies, and for blocks of P of these. Numbers by constraint are padded to whole
// vectors, N to N of the next kernel, unknowns to U.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "linsolve/block/pivots.h"
#include "linsolve/lanes.h"

namespace poinsot::block {

// Columns of S that are added up together, in registers; each panel leaves out unknowns that none of its columns of B
// has.
template <int N>
inline constexpr int kPanel = std::clamp(((kLanes == 8 ? 28 : 12) - padded(N) / kLanes) * kLanes / padded(N), 1, 5);
template <int N>
inline constexpr int kPanels = (N + kPanel<N> - 1) / kPanel<N>;

// a ← a⁻¹ as in invert_in_order() (pivots.h), of what is in registers already; `diagonal` keeps the pivots. A function
// of its own for both costs fronts up to a thirtieth of a step: compilers leave parts of it as calls.
template <int N, int C>
[[gnu::always_inline]] inline void invert_in_registers(Vec (&a)[N][C], Vec (&diagonal)[C]) {
  unrolled<N>([&](auto k) __attribute__((always_inline)) {
    constexpr int kChunk = k / kLanes, kLane = k % kLanes;
    diagonal[kChunk] = with<kLane>(diagonal[kChunk], a[k][kChunk]);
    const Vec minus = -1 / spread<kLane>(a[k][kChunk]);
    a[k][kChunk] = with<kLane>(a[k][kChunk], -1);
    if constexpr (k + 1 < N) {
      const Vec by = spread<kLane>(a[k + 1][kChunk]);
      a[k + 1][kChunk] = without<kLane>(a[k + 1][kChunk]);
      for (int c = 0; c < C; ++c) a[k + 1][c] += a[k][c] * by * minus;
    }
    for (int c = 0; c < C; ++c) a[k][c] *= minus;
    unrolled<N>([&](auto j) __attribute__((always_inline)) {
      if constexpr (j != k && j != k + 1) {
        const Vec by = spread<kLane>(a[j][kChunk]);
        a[j][kChunk] = without<kLane>(a[j][kChunk]);
        for (int c = 0; c < C; ++c) a[j][c] += a[k][c] * by;
      }
    });
  });
}

struct SchurPanels {
  const double* border;         // the identity where S has no rows of its own, else zero
  const std::uint8_t* unknown;  // panel by panel
  const std::uint8_t* const* last;
};

// S⁻¹ of S = L B, B being U × N, all column by column; its pivots, padded with ones.
template <int N, int U>
[[gnu::flatten]] void invert_schur(const double* L, const double* B, const SchurPanels& panels, double* inverse,
                                   double* pivots) {
  constexpr int C = padded(N) / kLanes, kStep = C * kLanes;
  Vec a[N][C], diagonal[C];
  const std::uint8_t* u = panels.unknown;
  unrolled<kPanels<N>>([&](auto panel) {
    constexpr int kFirst = panel * kPanel<N>, kWidth = std::min(kPanel<N>, N - kFirst);
    Vec sum[kWidth][C];
    unrolled<kWidth>([&](auto k) {
      unrolled<C>([&](auto c) { sum[k][c] = load(panels.border + (kFirst + k) * kStep + c * kLanes); });
    });
    for (; u != panels.last[panel]; ++u) {
      const double *l = L + *u * kStep, *b = B + *u;
      Vec x[C];
      unrolled<C>([&](auto c) { x[c] = load(l + c * kLanes); });
      unrolled<kWidth>([&](auto k) { unrolled<C>([&](auto c) { sum[k][c] += x[c] * b[(kFirst + k) * U]; }); });
    }
    unrolled<kWidth>([&](auto k) { unrolled<C>([&](auto c) { a[kFirst + k][c] = sum[k][c]; }); });
  });
  unrolled<C>([&](auto c) { diagonal[c] = 1 - Vec{}; });
  invert_in_registers(a, diagonal);
  unrolled<C>([&](auto c) { store(pivots + c * kLanes, diagonal[c]); });
  unrolled<N>([&](auto k) { unrolled<C>([&](auto c) { store(inverse + k * kStep + c * kLanes, a[k][c]); }); });
}

// What a solution is made of: λ = S⁻¹ (L f − γ), and B λ.
struct SchurFactors {
  const double *L, *B, *inverse;
  const int *unknown, *last, *row;  // entries of b that f stands in, and N of which the first are γ
  double *lambda, *forces;
};
template <int N, int U>
[[gnu::flatten]] void multipliers(const SchurFactors& of, const double* b) {
  constexpr int C = padded(N) / kLanes, kStep = C * kLanes, kForces = padded(U) / kLanes;
  Vec sum[2][C] = {}, x[2][C], w[2][kForces];
  const double* L = of.L;
  const auto take = [&](Vec(&to)[C], double by) {
    unrolled<C>([&](auto c) { to[c] += load(L + c * kLanes) * by; });
    L += kStep;
  };
  const int* unknown = of.unknown;
  for (; of.last - unknown >= 2; unknown += 2) {
    take(sum[0], b[unknown[0]]);
    take(sum[1], b[unknown[1]]);
  }
  if (unknown != of.last) take(sum[0], b[*unknown]);
  unrolled<C>([&](auto c) { store(of.lambda + c * kLanes, sum[0][c] + sum[1][c]); });
  unrolled<N>([&](auto k) {
    const double by = of.lambda[k] - b[of.row[k]];
    unrolled<C>([&](auto c) { add_to_one_of_two<k>(x, c, load(of.inverse + k * kStep + c * kLanes) * by); });
  });
  unrolled<C>([&](auto c) { store(of.lambda + c * kLanes, x[0][c] + x[1][c]); });
  unrolled<N>([&](auto k) {
    unrolled<kForces>([&](auto c) { add_to_one_of_two<k>(w, c, load(of.B + k * U + c * kLanes) * of.lambda[k]); });
  });
  unrolled<kForces>([&](auto c) { store(of.forces + c * kLanes, w[0][c] + w[1][c]); });
}

// L = G D⁻¹ for a block D of K, the columns `column` of G and L.
template <int P>
[[gnu::flatten]] void left(const double* inverse, const double* G, double* L, const int* column, int step) {
  int start[P];
  unrolled<P>([&](auto a) { start[a] = column[a] * step; });
  for (int row = 0; row < step; row += kLanes, G += kLanes, L += kLanes) {
    Vec g[P];
    unrolled<P>([&](auto a) { g[a] = load(G + start[a]); });
    unrolled<P>([&](auto b) {
      Vec sum = g[0] * inverse[b * P];
      unrolled<P>([&](auto a) {
        if constexpr (a > 0) sum += g[a] * inverse[b * P + a];
      });
      store(L + start[b], sum);
    });
  }
}

// v = D⁻¹ (f − B λ) in the entries of b that f stands in.
template <int P>
[[gnu::flatten]] void right(const double* inverse, const int* column, const int* unknown, const double* forces,
                            double* b) {
  double f[P];
  unrolled<P>([&](auto a) { f[a] = b[unknown[column[a]]] - forces[column[a]]; });
  unrolled<P>([&](auto a) {
    double sum = inverse[a] * f[0];
    unrolled<P>([&](auto c) {
      if constexpr (c > 0) sum += inverse[c * P + a] * f[c];
    });
    b[unknown[column[a]]] = sum;
  });
}

}  // namespace poinsot::block
