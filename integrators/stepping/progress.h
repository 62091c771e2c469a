// How steps under error control get on. Whenever their number has doubled, what they covered since is looked at.
//
// Where ever more of them cover ever less, towards a time before the end, they never come there: a body that is drawn
// in to a point turns the faster the nearer it is. Where they are as short as they may be for long, as of a body that
// turns a million times a second, the rest of the run is a matter of hours.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace poinsot {

class Progress {
 public:
  explicit Progress(double end) : end_(end), limit_(end) {}

  // A step ended at t. Says whether there is something new.
  bool look(double t) {
    if (++steps_ < next_) return false;
    const double way = t - t_, part = way_ > 0 ? way / way_ : 1;
    // Doubling on, they cover way (r + r² + ...).
    const double r = std::clamp(part, 1 + 1e-9, 2.0);
    left_ = static_cast<double>(steps_) * (std::exp2(std::log1p((end_ - t) / way * (r - 1) / r) / std::log(r)) - 1);
    limit_ = part < kPart ? t + way * part / (1 - part) : end_;
    in_a_row_ = limit_ < end_ ? in_a_row_ + 1 : 0;
    t_ = t;
    way_ = way;
    next_ *= 2;
    return true;
  }
  void begins_anew() { in_a_row_ = 0; }  // beyond a switch, towards which steps are short
  bool never_ends() const { return in_a_row_ >= kTold; }
  double limit() const { return limit_; }  // of time, s, which steps that never end do not come beyond
  bool takes_long() const { return steps_ >= kMany && left_ > kLong; }
  bool takes_long_for_a_rest() const { return steps_ >= kMany && left_ > kLongForARest; }
  double steps_left() const { return left_; }  // if it goes on as it did

 private:
  static constexpr int kTold = 4;
  static constexpr std::int64_t kFirst = 1024, kMany = 32 * kFirst;
  static constexpr double kPart = 0.95, kLong = 1e8, kLongForARest = 1e7;
  double end_, limit_, left_ = 0, t_ = 0, way_ = 0;
  std::int64_t steps_ = 0, next_ = kFirst;
  int in_a_row_ = 0;
};

}  // namespace poinsot
