// Vectors of the machine the program is compiled for, and loops written out: what the dense kernels are made of.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace poinsot {

#if defined(__AVX512F__)
inline constexpr int kLanes = 8;
#elif defined(__AVX__)
inline constexpr int kLanes = 4;
#else
inline constexpr int kLanes = 2;
#endif
constexpr int padded(int rows) {
  return (rows + kLanes - 1) / kLanes * kLanes;
}

// By the compilers' common extension; plain arithmetic on it.
typedef double Vec __attribute__((vector_size(kLanes * sizeof(double))));
inline Vec load(const double* x) {
  Vec v;
  std::memcpy(&v, x, sizeof v);
  return v;
}
inline void store(double* x, Vec v) {
  std::memcpy(x, &v, sizeof v);
}

// Calls f(std::integral_constant<int, k>()) for k = 0 … N − 1, each written out.
template <int N, class F>
inline void unrolled(F&& f) {
  [&]<int... k>(std::integer_sequence<int, k...>) {
    (f(std::integral_constant<int, k>()), ...);
  }
  (std::make_integer_sequence<int, N>());
}

// Two sums of C vectors each, of which none waits for the other: term k goes to one of them, the first ones begin them.
template <int k, int C>
inline void add_to_one_of_two(Vec (&sums)[2][C], int c, Vec term) {
  if constexpr (k < 2)
    sums[k][c] = term;
  else
    sums[k % 2][c] += term;
}

// Number i is f(std::integral_constant<int, i>()).
template <class F>
inline Vec vector(F&& f) {
  return [&]<int... i>(std::integer_sequence<int, i...>) {
    return Vec{f(std::integral_constant<int, i>())...};
  }
  (std::make_integer_sequence<int, kLanes>());
}

// Number `lane` everywhere; another number there, that of another vector, or zero.
template <int lane>
inline Vec spread(Vec x) {
  return [&]<int... i>(std::integer_sequence<int, i...>) {
    return __builtin_shufflevector(x, x, (i * 0 + lane)...);
  }
  (std::make_integer_sequence<int, kLanes>());
}
template <int lane>
inline Vec with(Vec x, double number) {
  return [&]<int... i>(std::integer_sequence<int, i...>) {
    return __builtin_shufflevector(x, number - Vec{}, (i == lane ? kLanes + i : i)...);
  }
  (std::make_integer_sequence<int, kLanes>());
}
template <int lane>
inline Vec with(Vec x, Vec other) {
  return [&]<int... i>(std::integer_sequence<int, i...>) {
    return __builtin_shufflevector(x, other, (i == lane ? kLanes + i : i)...);
  }
  (std::make_integer_sequence<int, kLanes>());
}
typedef std::int64_t Bits __attribute__((vector_size(kLanes * sizeof(std::int64_t))));
template <int lane>
inline Vec without(Vec x) {
  return [&]<int... i>(std::integer_sequence<int, i...>) {
    return reinterpret_cast<Vec>(reinterpret_cast<Bits>(x) & Bits{(i == lane ? 0 : -1)...});
  }
  (std::make_integer_sequence<int, kLanes>());
}
inline Vec magnitude(Vec x) {
  return reinterpret_cast<Vec>(reinterpret_cast<Bits>(x) & (INT64_MAX - Bits{}));
}

}  // namespace poinsot
