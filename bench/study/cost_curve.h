// What an accuracy costs with each method: curves through the measured cases, and which is below all others.
//
// A method's curve goes through those of its cases that none of its own beats, log time linear in log error between
// them. Where less accuracy is asked for than its coarsest case has, that case is what it costs; beyond its finest case
// there is nothing. Two curves are apart at an accuracy where their times differ by more than the noise: the root of
// the sum of squares of their spreads (distance of the quartiles over the median, of the larger of two neighbouring
// cases; CommonSpread of the chart).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/study/chart_file.h"
#include "bench/study/measure.h"

namespace poinsot::study {

struct CostCurve {
  struct Knot {
    double error, seconds, spread;
    std::size_t row;  // of the chart
  };
  std::string method;       // as ChartRow::method()
  std::vector<Knot> knots;  // from coarse to fine: errors fall, times grow

  // Nothing where it is not reached.
  std::optional<double> seconds_at(double error) const;
  double spread_at(double error) const;
};

// Errors below kResolved times `agreement` count as equal to that.
std::vector<CostCurve> cost_curves(const std::vector<ChartRow>& rows, std::size_t quantity, double agreement);

struct Standing {
  struct Place {
    std::size_t curve;
    double seconds;
  };
  std::vector<Place> order;  // of those that reach the accuracy, the fastest first
  std::size_t alike = 0;     // so many of them are not apart from the fastest, itself counted

  bool clear() const { return alike == 1; }
  // Time of the first that is apart from the fastest over the time of that; nothing where there is none.
  std::optional<double> margin() const;
};

class CostCurves {
 public:
  CostCurves(const std::vector<ChartRow>& rows, std::size_t quantity, double agreement);

  Standing at(double error) const;
  // By row: whether it lies on its method's curve and that is below all others there by more than the noise.
  std::vector<bool> front() const;
  // "1e-4 to 1e-6 in position: dop853 in rA, 1.3 to 1.5 times as fast as the next, dop853 in reps; ..." for the
  // accuracies that are even powers of ten.
  std::string conclusion() const;
  // All cases are as accurate as the reference can tell: what the panel would show is rounding.
  bool rounding_only() const;
  const std::vector<CostCurve>& all() const { return curves_; }

 private:
  std::size_t quantity_, rows_;
  double floor_;
  CommonSpread spread_;
  std::vector<CostCurve> curves_;
};

}  // namespace poinsot::study
