#include "bench/study/fit.h"

#include <cmath>
#include <vector>

#include "core/check.h"

namespace poinsot::study {

Line fit_line(std::span<const double> x, std::span<const double> y) {
  check(x.size() == y.size() && x.size() >= 2, "a line takes two points");
  const auto n = static_cast<double>(x.size());
  double mx = 0, my = 0;
  for (std::size_t k = 0; k < x.size(); ++k) mx += x[k] / n, my += y[k] / n;
  double sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    sxx += (x[k] - mx) * (x[k] - mx);
    sxy += (x[k] - mx) * (y[k] - my);
  }
  check(sxx > 0, "a line takes two different places");
  return {sxy / sxx, my - sxy / sxx * mx};
}

Power fit_power(std::span<const double> x, std::span<const double> y) {
  std::vector<double> lx, ly;
  for (double value : x) lx.push_back(std::log(value));
  for (double value : y) ly.push_back(std::log(value));
  Power power{fit_line(lx, ly).slope};
  for (std::size_t k = 1; k < lx.size(); ++k) power.neighbours.add((ly[k] - ly[k - 1]) / (lx[k] - lx[k - 1]));
  return power;
}

}  // namespace poinsot::study
