// Output times of integrators that choose their own steps: multiples of `every`, and the end.
#pragma once

#include <cmath>
#include <cstdint>

namespace poinsot {

class SampleTimes {
 public:
  // every = 0: no times of their own. check_counts() (integrators/settings_reader.h) saw to it that they can be
  // counted.
  SampleTimes(double every, double end) : every_(every), end_(end) {
    if (every <= 0) return;
    count_ = static_cast<std::int64_t>(std::floor(end / every + kSame));
    whole_ = std::abs(end / every - static_cast<double>(count_)) <= kSame;
  }

  // The first one not passed() yet; the end after the last multiple.
  double next() const {
    if (passed_ >= count_) return end_;
    const double k = static_cast<double>(passed_ + 1);
    return whole_ ? end_ * (k / static_cast<double>(count_)) : k * every_;  // as TimeGrid writes the same time
  }
  void pass() { ++passed_; }

 private:
  static constexpr double kSame = 1e-9;  // of `every`: rounding of decimal fractions

  double every_, end_;
  std::int64_t count_ = 0, passed_ = 0;
  bool whole_ = false;
};

}  // namespace poinsot
