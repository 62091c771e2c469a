// Watches one run for what a study keeps of it.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "bench/cases/kept.h"
#include "bench/study/range.h"
#include "bench/study/reference.h"

namespace poinsot::cases {

class Watch {
 public:
  // `columns`: of the quantities. The reference, where errors are kept, is given to fields().
  Watch(const Kept& kept, const std::vector<Column>& columns);

  void observe(const Sample& sample);
  // By Kept::columns() but for the seconds; not a number: there is none. `reference` may be null.
  std::vector<double> values(const Statistics& statistics, const study::Reference* reference) const;

 private:
  struct Seen {
    double last = std::numeric_limits<double>::quiet_NaN();
    study::Range range;
    std::vector<double> at;
  };
  void observe_energy(const Sample& sample);

  const Kept& kept_;
  const std::vector<Column>& columns_;
  SampleColumns samples_;
  std::vector<Seen> seen_;  // by quantity
  std::shared_ptr<const Model> model_;
  study::Motion motion_;
  std::optional<study::MotionRecorder> recorder_;
  std::vector<BodyState> bodies_;
  bool began_ = false, conservative_ = false;
  double energy_ = 0, drift_ = 0, kinetic_ = 0;  // J
};

}  // namespace poinsot::cases
