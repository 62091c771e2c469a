// Second-order Taylor numbers (f, ḟ, f̈): a function of one variable, by value and two derivatives.
#pragma once

namespace poinsot {

// Value and time derivatives of a function of time at one instant.
template <class T>
struct Jet2 {
  T f{};    // value
  T fd{};   // first derivative, 1/s
  T fdd{};  // second derivative, 1/s²
};

// φ(x) from the value of φ and its first two derivatives at x.f.
template <class T>
Jet2<T> compose(const Jet2<T>& x, T value, T first, T second) {
  return {value, first * x.fd, second * x.fd * x.fd + first * x.fdd};
}

}  // namespace poinsot
