// Whether rows that were set aside still hold: each is a row of the scene, which followed from those kept where it was
// set aside. Rows that one kept says word for word need no look.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/status.h"
#include "formulations/problem.h"
#include "integrators/start/row_choice.h"
#include "integrators/start/rows_aside.h"

namespace poinsot {

// Where a row set aside held least in a run, if more than what rounding and the kept rows' own residual explain.
struct Apart {
  double part;   // of what is allowed
  int row = -1;  // of the model; none
  double off = 0, t = 0;
};

// A sentence about it; empty where there is none.
std::string describe(const Apart& apart, const Model& model);

class AsideWatch {
 public:
  // Of what is allowed; what is less is not told.
  static constexpr double kWorthTelling = 0.01;  // what is said twice differs by more than its rounding

  // `kept`: the problem of the rows that `choice` keeps; both, and `apart`, outlive the watch. `to_tolerance`: kept
  // rows hold to a tolerance, and those that follow from them hold as far.
  AsideWatch(Problem& kept, const RowChoice& choice, bool to_tolerance, Apart& apart);

  bool measures_rates() const { return measures_rates_; }
  void kept_has_moved() { most_ = -1; }
  // |Φ| and |G v − ν| where the kept problem stands, at the most.
  LargestResidual left_out(double t);
  // Whether |Φ| is what is allowed there; of all that are measured.
  bool hold(double t);
  // Says which row does not hold any more. The kept problem stands at the end of a step; `a`: accelerations there.
  Status measure(double t, std::span<const double> a);

 private:
  double kept_off();
  double speed_at(const Row& row) const;
  Status measure_rates(double t, std::span<const double> a);

  Problem& kept_;
  const RowChoice& choice_;
  const bool to_tolerance_;
  Apart& apart_;
  std::optional<RowsAside> aside_;  // those that are measured, if any
  double most_ = -1;                // |Φ| of these where the kept problem stands; below 0: not known
  std::vector<double> by_allowed_;  // 1 over what is allowed of |Φ|, by row
  bool measures_rates_ = false;
  int lost_rates_ = 0;  // times, one after the other
  std::vector<double> kept_rates_, kept_positions_, no_accelerations_;
  std::vector<BodyState> now_;
};

}  // namespace poinsot
