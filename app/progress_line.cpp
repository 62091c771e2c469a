#include "app/progress_line.h"

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

ProgressLine::ProgressLine(std::string_view unit, bool wanted)
    : unit_(unit), enabled_(wanted && stderr_is_terminal()), start_(Clock::now()), next_(start_ + kFirst) {}

study::ProgressCallback ProgressLine::callback() {
  if (!enabled_) return {};
  return [this](const study::Progress& progress) { at(progress); };
}

void ProgressLine::at(const study::Progress& progress, std::string_view more) {
  const auto& [done, all, skipped] = progress;
  if (!enabled_) return;
  const auto now = Clock::now();
  if (done == 0) {  // another computation begins
    start_ = now;
    next_ = now + kFirst;
  }
  if (now < next_ || done <= skipped) return;
  next_ = now + kBetween;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  fmt::print(stderr, "\r\x1b[K{:3.0f} %  {:.6g} of {:.6g} {}, {} left{}", 100 * done / all, done, all, unit_,
             duration(elapsed * (all - done) / (done - skipped)), more);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressLine::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace poinsot::app
