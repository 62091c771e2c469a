#include "app/progress.h"

#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "app/terminal.h"

namespace poinsot::app {
namespace {

constexpr std::chrono::milliseconds kFirst{500};    // short runs draw nothing
constexpr std::chrono::milliseconds kBetween{200};  // between two drawings

std::string duration(double seconds) {
  if (seconds < 60) return fmt::format("{:.0f} s", seconds);
  const auto minutes = static_cast<long>(seconds / 60);
  if (minutes < 60) return fmt::format("{} min {:.0f} s", minutes, seconds - 60.0 * static_cast<double>(minutes));
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

}  // namespace

Progress::Progress(double end, std::string_view unit, bool wanted)
    : end_(end), unit_(unit), enabled_(wanted && stderr_is_terminal()), next_(start_ + kFirst) {}

void Progress::at(double done) {
  if (!enabled_ || done <= skipped_) return;
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + kBetween;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  fmt::print(stderr, "\r\x1b[K{:3.0f} %  {:.6g} of {:.6g} {}, {} left", 100 * done / end_, done, end_, unit_,
             duration(elapsed * (end_ - done) / (done - skipped_)));
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace poinsot::app
