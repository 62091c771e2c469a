#include "bench/study/interval.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace poinsot::study {

Interval median_interval(std::vector<double> values, double confidence) {
  check(!values.empty(), "a median is one of values");
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  Interval result{(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back(), 0};
  double term = std::ldexp(1.0, -static_cast<int>(n)), below = term;  // P(B = j), P(B < j + 1)
  for (std::size_t k = 1; 2 * k <= n; ++k) {
    const double reached = 1 - 2 * below;
    if (k > 1 && reached < confidence) break;
    result.low = values[k - 1], result.high = values[n - k], result.confidence = reached;
    term *= static_cast<double>(n - k + 1) / static_cast<double>(k);
    below += term;
  }
  return result;
}

}  // namespace poinsot::study
