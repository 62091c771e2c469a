// A floating-point number with the digits of M and an exponent of 64 bits: m 2^e, |m| in [1/2, 1); 0, infinities and
// what is no number are M's, with e = 0.
//
// For what overflows on the way to a number of ordinary size, as 1/(1 + exp(−1000 x)) does at x = −1. Roots, powers and
// elementary functions are those of M wherever arguments and results fit into it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace poinsot {

template <class M>
class Wide {
 public:
  Wide() = default;
  Wide(M x) { *this = scaled(x, 0); }  // by itself: formulas for M serve
  explicit operator M() const {
    return std::isfinite(m_) ? std::ldexp(m_, static_cast<int>(std::clamp<std::int64_t>(e_, -kBeyond, kBeyond))) : m_;
  }

  friend Wide operator-(const Wide& x) { return scaled(-x.m_, x.e_); }
  friend Wide operator+(const Wide& x, const Wide& y) {
    if (!x.usual() || !y.usual()) return x.m_ == 0 ? y : y.m_ == 0 ? x : Wide(x.m_ + y.m_);
    if (x.e_ < y.e_) return y + x;
    return x.e_ - y.e_ > kBeyond ? x : scaled(x.m_ + std::ldexp(y.m_, static_cast<int>(y.e_ - x.e_)), x.e_);
  }
  friend Wide operator-(const Wide& x, const Wide& y) { return x + -y; }
  friend Wide operator*(const Wide& x, const Wide& y) { return scaled(x.m_ * y.m_, x.e_ + y.e_); }
  friend Wide operator/(const Wide& x, const Wide& y) { return scaled(x.m_ / y.m_, x.e_ - y.e_); }

  friend bool operator<(const Wide& x, const Wide& y) { return (x - y).m_ < 0; }
  friend bool operator>(const Wide& x, const Wide& y) { return y < x; }
  friend bool operator>=(const Wide& x, const Wide& y) { return (x - y).m_ >= 0; }
  friend bool operator==(const Wide& x, const Wide& y) { return x.m_ == y.m_ && x.e_ == y.e_; }

  friend Wide abs(const Wide& x) { return scaled(std::abs(x.m_), x.e_); }
  friend Wide sqrt(const Wide& x) {
    const bool odd = x.e_ % 2 != 0;
    return scaled(std::sqrt(odd ? 2 * x.m_ : x.m_), (x.e_ - (odd ? 1 : 0)) / 2);
  }
  friend Wide exp(const Wide& x) {
    const M by = M(x), k = std::floor(by / ln2());
    if (!(std::abs(k) < M(kLargest))) return Wide(std::exp(by));
    // ln 2 in two parts, the first of few enough digits that k times it is exact up to k of 2^30 and more.
    const M high = static_cast<M>(static_cast<float>(ln2()));
    const M low = static_cast<M>(0.693147180559945309417232121458176568L - static_cast<long double>(high));
    return scaled(std::exp((by - k * high) - k * low), static_cast<std::int64_t>(k));
  }
  friend Wide log(const Wide& x) {
    return x.usual() ? Wide(std::log(x.m_) + static_cast<M>(x.e_) * ln2()) : Wide(std::log(x.m_));
  }
  friend Wide pow(const Wide& x, const Wide& y) {
    const M f = std::pow(M(x), M(y));
    if ((f != 0 && !std::isinf(f)) || !x.usual() || !y.usual()) return Wide(f);  // no number stays none
    const Wide size = exp(y * log(abs(x)));
    return std::signbit(f) ? -size : size;
  }
  friend Wide sinh(const Wide& x) { return (exp(x) - exp(-x)) / 2; }
  friend Wide cosh(const Wide& x) { return (exp(x) + exp(-x)) / 2; }
  friend Wide tanh(const Wide& x) { return std::tanh(M(x)); }
  friend Wide sin(const Wide& x) { return std::sin(M(x)); }
  friend Wide cos(const Wide& x) { return std::cos(M(x)); }
  friend Wide tan(const Wide& x) { return std::tan(M(x)); }
  friend Wide asin(const Wide& x) { return std::asin(M(x)); }
  friend Wide acos(const Wide& x) { return std::acos(M(x)); }
  friend Wide atan(const Wide& x) { return std::atan(M(x)); }
  friend Wide hypot(const Wide& x, const Wide& y) { return sqrt(x * x + y * y); }
  friend Wide atan2(const Wide& y, const Wide& x) {
    const std::int64_t e = std::max(x.e_, y.e_);
    return std::atan2(M(scaled(y.m_, y.e_ - e)), M(scaled(x.m_, x.e_ - e)));
  }

 private:
  static constexpr int kBeyond = 40000;  // exponents that no M has
  static constexpr std::int64_t kLargest = std::int64_t{1} << 60;
  static constexpr M ln2() { return static_cast<M>(0.693147180559945309417232121458176568L); }

  static Wide scaled(M m, std::int64_t e) {
    Wide x;
    int of_m = 0;
    x.m_ = std::frexp(m, &of_m);
    x.e_ = x.usual() ? e + of_m : 0;
    return x;
  }
  bool usual() const { return m_ != 0 && std::isfinite(m_); }

  M m_ = 0;
  std::int64_t e_ = 0;
};

}  // namespace poinsot
