// Time by phase at a cost that does not show in steps of a microsecond.
//
// On x86-64 the processor's time-stamp counter is read (constant rate, some ten nanoseconds cheaper than the system
// clock) and scaled at the end by the system clock's total; elsewhere the system clock itself is read.
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
    began_ = std::chrono::steady_clock::now();
    first_ = last_ = ticks();
  }
  // The time since the last call belongs to this phase.
  void lap(Phase phase) {
    const std::uint64_t now = ticks();
    ticks_[static_cast<std::size_t>(phase)] += now - last_;
    last_ = now;
  }
  // Leaves out what passed since the last call: reading and writing.
  void skip() {
    const std::uint64_t now = ticks();
    skipped_ += now - last_;
    last_ = now;
  }
  void stop() {
    lap(Phase::other);
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    const std::uint64_t all = last_ - first_;
    scale_ = all > 0 ? elapsed / static_cast<double>(all) : 0;
  }
  double seconds(Phase phase) const { return scale_ * static_cast<double>(ticks_[static_cast<std::size_t>(phase)]); }
  double total() const { return scale_ * static_cast<double>(last_ - first_ - skipped_); }

 private:
  static std::uint64_t ticks() {
#if defined(__x86_64__)
    return __rdtsc();
#else
    return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
  }

  std::chrono::steady_clock::time_point began_;
  std::uint64_t first_ = 0, last_ = 0, skipped_ = 0;
  std::array<std::uint64_t, 4> ticks_{};
  double scale_ = 0;
};

}  // namespace poinsot
