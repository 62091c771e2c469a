// Smallest and largest of the values seen.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

namespace poinsot::study {

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
  // "1.20 to 1.55"
  std::string text(int decimals) const { return fmt::format("{:.{}f} to {:.{}f}", low, decimals, high, decimals); }
};

}  // namespace poinsot::study
