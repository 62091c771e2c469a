// Random numbers by counter: the k-th number of a stream is a function of seed, stream and k alone, so that a case
// draws the same whoever computes it, and in whatever order.
//
// The generator is Philox4x32-10 (Salmon, Moraes, Dror, Shaw, Parallel random numbers: as easy as 1, 2, 3, SC 2011);
// the inverse of the normal distribution is Wichura's PPND16 (Algorithm AS 241, Applied Statistics 37, 1988). Neither
// depends on the language's library, whose distributions differ from one to the next.
#pragma once

#include <array>
#include <cstdint>

namespace poinsot::cases {

using PhiloxCounter = std::array<std::uint32_t, 4>;
PhiloxCounter philox(PhiloxCounter counter, std::array<std::uint32_t, 2> key);

struct RandomStream {
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;

  // Number k, in (0, 1), both ends excluded.
  double uniform(std::uint64_t k) const;
  // Where a random permutation of 0 .. n − 1 takes k: a Feistel network over the next power of four, walked until it
  // falls below n. Nothing is stored.
  std::uint64_t permuted(std::uint64_t k, std::uint64_t n) const;
};

// x with Φ(x) = p of the standard normal distribution, 0 < p < 1, to about 16 digits.
double normal_quantile(double p);

}  // namespace poinsot::cases
