// Derivatives of what a test computes for itself.
#pragma once

#include <type_traits>

namespace poinsot::test {

// x'(t) of a number, vector or matrix by central differences of fourth order.
template <class F>
auto time_rate(const F& x, double t, double h = 1e-3) {
  using X = std::decay_t<decltype(x(t))>;
  const X near = x(t + h) - x(t - h), far = x(t + 2 * h) - x(t - 2 * h);
  return X((8 * near - far) / (12 * h));
}

}  // namespace poinsot::test
