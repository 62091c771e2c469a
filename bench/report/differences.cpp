#include "bench/report/differences.h"

#include <fmt/format.h>

#include <cmath>

namespace poinsot::report {

using namespace study;

std::string why_no_times(const CsvTable& a, const CsvTable& b) {
  for (const auto& [key, what] :
       {std::pair{"processor", "another processor"}, {"compiler", "another compiler or flags"}})
    if (a.note(key) != b.note(key)) return fmt::format("{}: found \"{}\" and \"{}\"", what, a.note(key), b.note(key));
  return {};
}

void Differences::leave_out(const std::string& file, const std::string& what, const std::string& why) {
  told_.not_compared.push_back(fmt::format("{}: {}: {}", file, what, why));
}

void Differences::leave_out_all(const std::string& file, const std::string& why) {
  leave_out(file, "nothing", why);
  told_.incomparable = true;
}

void Differences::origin(const char* key, const std::string& a, const std::string& b) {
  if (a != b) told_.origins.push_back({key, a, b});
}

void Differences::changed(const std::string& file, const std::string& cell, const std::string& quantity,
                          const std::string& before, const std::string& after) {
  if (before != after) told_.changed.push_back({file, cell, quantity, before, after});
}

void Differences::times(const RawCell& a, const RawCell& b) {
  std::vector<double> ratios, before, after;
  for (const auto& [repetition, run] : a.repetitions) {
    const auto other = b.repetitions.find(repetition);
    if (other == b.repetitions.end() || !(run.total > 0) || !(other->second.total > 0)) continue;
    ratios.push_back(other->second.total / run.total);
    before.push_back(run.total), after.push_back(other->second.total);
  }
  if (ratios.empty()) return;
  const Interval ratio = median_interval(ratios, kOfChange);
  ++told_.times;
  quotients_.push_back(ratio.median);
  if (ratio.confidence > 0) told_.by_chance += 1 - ratio.confidence;
  if (ratio.confidence > 0 && !ratio.contains(1))
    told_.changed_times.push_back(
        {"raw.csv", a.name(), median_interval(before).median, median_interval(after).median, ratio});
}

void Differences::times_by_spreads(const std::string& file, const std::string& cell, const Timed& a, const Timed& b,
                                   const CommonSpread& common) {
  constexpr double kTimes = 3, kBetweenRuns = 0.1;
  if (!(a.seconds > 0) || !(b.seconds > 0)) return;
  const double spread = std::hypot(common.of(a.spread), common.of(b.spread));
  const double ratio = b.seconds / a.seconds, noise = 1 + std::max(kBetweenRuns, kTimes * spread);
  ++told_.times;
  quotients_.push_back(ratio);
  if (ratio > noise || ratio * noise < 1)
    told_.changed_times.push_back({file, cell, a.seconds, b.seconds, {ratio, ratio / noise, ratio * noise, 0}});
}

Comparison Differences::told() && {
  if (!quotients_.empty()) told_.common = median_interval(quotients_).median;
  return std::move(told_);
}

}  // namespace poinsot::report
