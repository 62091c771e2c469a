// The line in which atoms wait for their elimination goes by degree, then by number.
#include "linsolve/block/least_first.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <utility>
#include <vector>

namespace poinsot::test {
namespace {

// Against a set of pairs: a few numbers and many, degrees near each other and far apart.
TEST(LeastFirst, GoesByDegreeThenByNumber) {
  std::mt19937 random(1);
  for (const int n : {1, 63, 64, 65, 5000, 300'000}) {
    block::LeastFirst line(n);
    std::set<std::pair<int, int>> expected;
    std::vector<int> degree(static_cast<std::size_t>(n), -1);
    const auto below = [&](int bound) { return static_cast<int>(random() % static_cast<unsigned>(bound)); };
    for (int k = 0; k < 20'000; ++k) {
      if (random() % 3 == 0) {
        const int first = line.take();
        ASSERT_EQ(first, expected.empty() ? -1 : expected.begin()->second) << n << ", " << k;
        if (first < 0) continue;
        expected.erase(expected.begin());
        degree[static_cast<std::size_t>(first)] = -1;
      } else {
        const int number = below(n), to = random() % 10 == 0 ? below(1'000'000) : below(40);
        int& at = degree[static_cast<std::size_t>(number)];
        expected.erase({at, number});
        expected.insert({at = to, number});
        line.put(number, to);
      }
    }
  }
}

}  // namespace
}  // namespace poinsot::test
