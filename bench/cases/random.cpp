#include "bench/cases/random.h"

#include <cmath>
#include <initializer_list>
#include <utility>

namespace poinsot::cases {
namespace {

// What a number is drawn for: the last word of the counter keeps the two apart.
enum : std::uint32_t { kUniform = 0, kPermutation = 1 };

std::uint32_t low(std::uint64_t x) {
  return static_cast<std::uint32_t>(x);
}
std::uint32_t high(std::uint64_t x) {
  return static_cast<std::uint32_t>(x >> 32);
}

// c[0] + c[1] x + c[2] x² + ...
double polynomial(std::initializer_list<double> c, double x) {
  double sum = 0;
  for (auto term = std::rbegin(c); term != std::rend(c); ++term) sum = sum * x + *term;
  return sum;
}

}  // namespace

PhiloxCounter philox(PhiloxCounter c, std::array<std::uint32_t, 2> key) {
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t p = std::uint64_t{0xD2511F53} * c[0], q = std::uint64_t{0xCD9E8D57} * c[2];
    c = {high(q) ^ c[1] ^ key[0], low(q), high(p) ^ c[3] ^ key[1], low(p)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return c;
}

double RandomStream::uniform(std::uint64_t k) const {
  const PhiloxCounter word = philox({low(k), high(k), stream, kUniform}, {low(seed), high(seed)});
  const std::uint64_t bits = (std::uint64_t{word[0]} << 20) | (word[1] >> 12);  // 52, and half of the last
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

std::uint64_t RandomStream::permuted(std::uint64_t k, std::uint64_t n) const {
  constexpr std::uint32_t kRounds = 6;
  int half = 1;  // bits
  while (half < 32 && (std::uint64_t{1} << (2 * half)) < n) ++half;
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  do {
    std::uint64_t left = k >> half, right = k & mask;
    for (std::uint32_t round = 0; round < kRounds; ++round) {
      const PhiloxCounter word =
          philox({low(right), round, stream, kPermutation}, {low(seed), high(seed) ^ static_cast<std::uint32_t>(half)});
      left = std::exchange(right, (left ^ word[0]) & mask);
    }
    k = left << half | right;
  } while (k >= n);
  return k;
}

double normal_quantile(double p) {
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q *
           polynomial(
               {3.3871328727963666080, 1.3314166789178437745e2, 1.9715909503065514427e3, 1.3731693765509461125e4,
                4.5921953931549871457e4, 6.7265770927008700853e4, 3.3430575583588128105e4, 2.5090809287301226727e3},
               r) /
           polynomial(
               {1, 4.2313330701600911252e1, 6.8718700749205790830e2, 5.3941960214247511077e3, 2.1213794301586595867e4,
                3.9307895800092710610e4, 2.8729085735721942674e4, 5.2264952788528545610e3},
               r);
  }
  const double r = std::sqrt(-std::log(q < 0 ? p : 1 - p));
  const double x =
      r <= 5 ? polynomial({1.42343711074968357734, 4.63033784615654529590, 5.76949722146069140550,
                           3.64784832476320460504, 1.27045825245236838258, 2.41780725177450611770e-1,
                           2.27238449892691845833e-2, 7.74545014278341407640e-4},
                          r - 1.6) /
                   polynomial({1, 2.05319162663775882187, 1.67638483018380384940, 6.89767334985100004550e-1,
                               1.48103976427480074590e-1, 1.51986665636164571966e-2, 5.47593808499534494600e-4,
                               1.05075007164441684324e-9},
                              r - 1.6)
             : polynomial({6.65790464350110377720, 5.46378491116411436990, 1.78482653991729133580,
                           2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                           2.71155556874348757815e-5, 2.01033439929228813265e-7},
                          r - 5) /
                   polynomial({1, 5.99832206555887937690e-1, 1.36929880922735805310e-1, 1.48753612908506148525e-2,
                               7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7,
                               2.04426310338993978564e-15},
                              r - 5);
  return q < 0 ? -x : x;
}

}  // namespace poinsot::cases
