// Time by phase at a cost that does not show in steps of a microsecond.
//
// On x86-64 the processor's time-stamp counter is read (constant rate, some ten nanoseconds cheaper than the system
// clock) and scaled at the end by the system clock's total; elsewhere the system clock itself is read. The total is
// measured. Of the phases, every lap is looked at in the first thousand, which is all of a short run or of one whose
// phases take long; from then on a few in a row of many, and the time until they are looked at again is divided among
// the phases as the time of those was.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace poinsot {

enum class Phase { assembly, factor, solve, other };

class PhaseClock {
 public:
  void start() {
    *this = {};
    began_ = std::chrono::steady_clock::now();
    first_ = divided_ = last_ = ticks();
  }
  // The time since the last call belongs to this phase.
  void lap(Phase phase) {
    if (--laps_ <= 0) return look_again();
    if (laps_ > kUnseen) see(phase, ticks());
  }
  // What passes between the two is left out: reading and writing.
  void pause() {
    const std::uint64_t now = ticks();
    if (laps_ > kUnseen) see(Phase::other, now);
    paused_ = now;
  }
  void resume() {
    const std::uint64_t now = ticks(), pause = now - paused_;
    skipped_ += pause;
    divided_ += pause;
    last_ = now;
  }
  void stop() {
    const std::uint64_t now = ticks();
    if (laps_ > kUnseen) see(Phase::other, now);
    divide(now);
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    const std::uint64_t all = now - first_;
    scale_ = all > 0 ? elapsed / static_cast<double>(all) : 0;
    total_ = all - skipped_;
  }
  double seconds(Phase phase) const { return scale_ * ticks_[static_cast<std::size_t>(phase)]; }
  double total() const { return scale_ * static_cast<double>(total_); }

 private:
  static constexpr int kFirst = 1024, kSeen = 128, kUnseen = 1920;  // laps

  void see(Phase phase, std::uint64_t now) {
    seen_[static_cast<std::size_t>(phase)] += now - last_;
    last_ = now;
  }
  void look_again() {
    const std::uint64_t now = ticks();
    divide(now);
    last_ = now;
    laps_ = kSeen + kUnseen;
  }
  // The time up to now, as what was seen of it.
  void divide(std::uint64_t now) {
    std::uint64_t all = 0;
    for (const std::uint64_t seen : seen_) all += seen;
    const double share = all > 0 ? static_cast<double>(now - divided_) / static_cast<double>(all) : 0;
    for (std::size_t k = 0; k < seen_.size(); ++k) ticks_[k] += share * static_cast<double>(seen_[k]);
    seen_ = {};
    divided_ = now;
  }
  static std::uint64_t ticks() {
#if defined(__x86_64__)
    return __rdtsc();
#else
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
  }

  std::chrono::steady_clock::time_point began_;
  std::uint64_t first_ = 0, last_ = 0, paused_ = 0, skipped_ = 0, total_ = 0;
  std::uint64_t divided_ = 0;  // up to here time is divided among the phases
  int laps_ = kFirst + kUnseen;
  std::array<std::uint64_t, 4> seen_{};
  std::array<double, 4> ticks_{};
  double scale_ = 0;
};

}  // namespace poinsot
