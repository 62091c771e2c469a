// The pivot block of a front (linsolve/block/schedule.h), factored or inverted where it lies:
//
//   D⁻¹              where that is harmless: what follows multiplies with it, by sums that do not wait for one
//                    another, where factors are a chain of twice p divisions and multiplications;
//   P_r D = L_D U_D  else. Entries of D⁻¹ are large where D is nearly singular, and cancel in D⁻¹ b, which loses
//                    digits that substitution keeps; so do the inverses of L_D and U_D, if less.
//
// Rows go in the order of pivots in both.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "core/index.h"
#include "linsolve/lanes.h"

namespace poinsot::block {

// A candidate this many times larger than the diagonal takes its place where pivots are chosen; where an order chosen
// before is kept, its pivots may fall behind as much more again. At 10, 7414 of those solutions (kHarmless) left
// more than 3e-15.
inline constexpr double kReluctance = 4;

// How far pivots are from those of a factorization that was examined, in the units of their rows, which may have
// changed places: the least and the largest |u| / |u then|.
struct Drift {
  double least = 1, largest = 1, poison = 0;  // poison is 0 while all pivots are numbers

  void add(double ratio) {
    least = std::min(least, ratio);
    largest = std::max(largest, ratio);
    poison += ratio * 0;
  }
  bool within(double range) const { return poison == 0 && least * range >= 1 && largest <= range; }
  // No farther than others, give or take a factor.
  bool like(const Drift& seen, double factor) const {
    return least * factor >= seen.least && largest <= factor * seen.largest;
  }
};

// Kernels are written out for fewer pivots.
inline constexpr int kKernels = 9;

// By how much rounding in D⁻¹ b may be magnified. Of 169 755 solutions of planar loops (four and six links, alone and
// carried, with rows too many and without, four methods) 5506 left more than 3e-15 so, and 4144 with factors alone.
inline constexpr double kHarmless = 100;

// How a front's pivots are chosen: `order` is that of its rows, `moved` tells whether it is another than 0, 1, 2, …
struct Choice {
  std::uint16_t* order;
  const float* weight;  // the units of rows
  float* then;          // 1/|pivot| in these units of the factorization Drift compares with
  bool moved, whole;    // whole: D⁻¹ is harmless
  bool keep;     // all this of the last factorization, while it serves; else later ones are compared with this one
  bool inverse;  // D⁻¹ may be chosen
};

inline float in_range(double x) {
  return static_cast<float>(std::clamp(x, 1e-37, 1e37));
}

// D ← its factors, p × p, the diagonal of U_D inverted, with its rows in the order of `choice`, in straight-line code.
// False, and D as it was, where a candidate is more than `reluctance` times a pivot. Flattened, or the compiler leaves
// parts of it as calls, with all numbers through memory.
template <int P>
[[gnu::flatten]] inline bool factor_in_order(double* D, const Choice& choice, double reluctance, Drift& drift) {
  double a[P * P], unit[P];
  const std::uint16_t* order = choice.moved ? choice.order : nullptr;
  if (order) {
    unrolled<P>([&](auto i) {
      const int row = order[i];
      unit[i] = choice.weight[row];
      unrolled<P>([&](auto k) { a[k * P + i] = D[k * P + row]; });
    });
  } else {
    unrolled<P * P>([&](auto k) { a[k] = D[k]; });
    unrolled<P>([&](auto i) { unit[i] = choice.weight[i]; });
  }
  double excess = 0;
  Drift seen = drift;
  unrolled<P>([&](auto k) {
    double largest = 0;
    unrolled<P>([&](auto i) {
      if constexpr (i > k) largest = std::max(largest, std::abs(a[k * P + i]) * unit[i]);
    });
    excess = std::max(excess, largest - reluctance * std::abs(a[k * P + k]) * unit[k]);
    seen.add(std::abs(a[k * P + k]) * unit[k] * choice.then[k]);
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

// D ← (P_r D)⁻¹ likewise, by Gauss and Jordan's elimination of whole vectors.
template <int P>
[[gnu::flatten]] inline bool invert_in_order(double* D, const Choice& choice, double reluctance, Drift& drift) {
  constexpr int C = padded(P) / kLanes;
  Vec a[P][C], unit[C];  // unit: of rows that have not been pivots
  const std::uint16_t* order = choice.moved ? choice.order : nullptr;
  const auto each = [&](auto&& number) {
    unrolled<C>(
        [&](auto c) { unit[c] = vector([&](auto i) { return number(c * kLanes + i.value, choice.weight, P); }); });
    unrolled<P>([&](auto k) {
      unrolled<C>(
          [&](auto c) { a[k][c] = vector([&](auto i) { return number(c * kLanes + i.value, D + k * P, P); }); });
    });
  };
  if (order) {
    each([&](int i, const auto* x, int p) { return i < p ? double{x[order[i]]} : 0.0; });
  } else {
    each([](int i, const auto* x, int p) { return i < p ? double{x[i]} : 0.0; });
  }
  Vec excess = {};
  Drift seen = drift;
  unrolled<P>([&](auto k) {
    constexpr int kChunk = k / kLanes, kLane = k % kLanes;
    const double pivot = std::abs(a[k][kChunk][kLane]) * double{choice.weight[order ? order[k] : k.value]};
    seen.add(pivot * double{choice.then[k]});
    const Vec minus = -1 / spread<kLane>(a[k][kChunk]);
    unit[kChunk] = without<kLane>(unit[kChunk]);
    unrolled<C>([&](auto c) {
      const Vec beyond = magnitude(a[k][c]) * unit[c] - reluctance * pivot;
      excess = beyond > excess ? beyond : excess;
    });
    a[k][kChunk] = with<kLane>(a[k][kChunk], -1);
    if constexpr (k + 1 < P) {  // what the next step waits for, by one multiplication sooner
      const Vec by = spread<kLane>(a[k + 1][kChunk]);
      a[k + 1][kChunk] = without<kLane>(a[k + 1][kChunk]);
      unrolled<C>([&](auto c) { a[k + 1][c] += a[k][c] * by * minus; });
    }
    unrolled<C>([&](auto c) { a[k][c] *= minus; });
    unrolled<P>([&](auto j) {
      if constexpr (j != k && j != k + 1) {
        const Vec by = spread<kLane>(a[j][kChunk]);
        a[j][kChunk] = without<kLane>(a[j][kChunk]);
        unrolled<C>([&](auto c) { a[j][c] += a[k][c] * by; });
      }
    });
  });
  for (int i = 0; i < kLanes; ++i)
    if (!(excess[i] <= 0)) return false;
  drift = seen;
  unrolled<P>([&](auto k) {
    double* column = D + k * P;
    unrolled<C>([&](auto c) {
      // Whole vectors, whose surplus the next column overwrites, where there is one.
      constexpr bool kWhole = k * P + (c + 1) * kLanes <= P * P;
      constexpr int kRest = P - c * kLanes < kLanes ? P - c * kLanes : kLanes;
      if constexpr (kWhole)
        store(column + c * kLanes, a[k][c]);
      else
        std::memcpy(column + c * kLanes, &a[k][c], kRest * sizeof(double));
    });
  });
  return true;
}

// D ← its factors with the order chosen here: the diagonal while it serves, so that kept orders and pivots stay
// comparable. `unit` has room for p numbers.
inline void factor_choosing(double* D, int p, Choice& choice, double* unit, Drift& drift) {
  choice.moved = false;
  for (int i = 0; i < p; ++i) choice.order[i] = static_cast<std::uint16_t>(i), unit[i] = choice.weight[i];
  for (int k = 0; k < p; ++k) {
    double* column = D + k * p;
    int best = k;
    double largest = 0;
    for (int i = k + 1; i < p; ++i) largest = std::max(largest, std::abs(column[i]) * unit[i]);
    if (largest > kReluctance * std::abs(column[k]) * unit[k]) {
      while (std::abs(column[best]) * unit[best] != largest) ++best;
      for (int j = 0; j < p; ++j) std::swap(D[j * p + k], D[j * p + best]);
      std::swap(unit[k], unit[best]);
      std::swap(choice.order[k], choice.order[best]);
      choice.moved = true;
    }
    const double pivot = std::abs(column[k]) * unit[k];
    drift.add(pivot * double{choice.then[k]});
    if (!choice.keep) choice.then[k] = in_range(1 / pivot);
    const double inverse = 1 / column[k];
    column[k] = inverse;
    for (int i = k + 1; i < p; ++i) column[i] *= inverse;
    for (int j = k + 1; j < p; ++j) {
      const double u = D[j * p + k];
      for (int i = k + 1; i < p; ++i) D[j * p + i] -= column[i] * u;
    }
  }
}

// x ← (L_D U_D)⁻¹ x, the first entry that is not zero being number `first`.
inline void substitute(const double* D, int p, int first, double* x) {
  for (int k = first; k < p; ++k)
    for (int i = k + 1; i < p; ++i) x[i] -= D[k * p + i] * x[k];
  for (int k = p - 1; k >= 0; --k) {
    x[k] *= D[k * p + k];
    for (int i = 0; i < k; ++i) x[i] -= D[k * p + i] * x[k];
  }
}

// Whether each row of |D| |D⁻¹| sums up to little, in the units of rows: by so much rounding in D⁻¹ b is magnified in
// the residual.
inline bool harmless(const double* D, const double* factors, int p, const Choice& choice) {
  std::array<double, kKernels> sums{};
  for (int k = 0; k < p; ++k) {
    std::array<double, kKernels> x{};  // column k of (P_r D)⁻¹
    x[index(k)] = 1;
    substitute(factors, p, k, x.data());
    const double unit = choice.weight[choice.moved ? choice.order[k] : k];
    for (int i = 0; i < p; ++i)
      for (int row = 0; row < p; ++row)
        sums[index(row)] += std::abs(D[i * p + row] * x[index(i)]) * choice.weight[row] / unit;
  }
  return std::ranges::all_of(sums, [](double sum) { return sum <= kHarmless; });
}

// The order and its pivots, and whether D⁻¹ serves; D stays.
inline void choose(const double* D, int p, Choice& choice) {
  std::array<double, kKernels * kKernels> factors;
  std::array<double, kKernels> unit;
  std::copy_n(D, p * p, factors.begin());
  Drift unused;
  factor_choosing(factors.data(), p, choice, unit.data(), unused);
  choice.whole = choice.inverse && harmless(D, factors.data(), p, choice);
}

}  // namespace poinsot::block
