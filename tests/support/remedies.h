// What a run that stopped says to try, and the same run with it.
#pragma once

#include <gmock/gmock.h>

#include <cmath>
#include <optional>
#include <regex>
#include <string>

#include "tests/support/simulation.h"

namespace poinsot::test {

// Of "try a step of at most 0.009 s", s.
inline std::optional<double> offered_step(const std::string& message) {
  std::smatch found;
  if (!std::regex_search(message, found, std::regex("try a step of at most ([0-9.e+-]+) s"))) return {};
  return std::stod(found[1]);
}

// "; try a smaller step": what a run that stopped says to try.
inline std::string remedy_of(const Recorded& run) {
  const Status& status = run.outcome.status;
  return status.remedy > 0 ? status.message.substr(status.remedy) : "";
}

// The longest step not above `most` that ends on the end.
inline Settings with_step(Settings settings, double most) {
  settings.step = settings.end / std::ceil(settings.end / most * (1 - 1e-12));
  settings.every = 0;
  return settings;
}

// A stop says when, of what, and what to try; what had been computed is there.
inline void expect_stopped(const Recorded& run, Failure failure, const char* of, const char* remedy) {
  EXPECT_EQ(run.outcome.status.failure, failure) << run.outcome.status.message;
  EXPECT_THAT(run.outcome.status.message, ::testing::HasSubstr(fmt::format("t = {:.9g} s", run.outcome.status.time)));
  EXPECT_THAT(run.outcome.status.message, ::testing::HasSubstr(of));
  EXPECT_THAT(run.outcome.status.message, ::testing::HasSubstr(remedy));
  if (!run.samples.empty()) {
    EXPECT_LE(run.samples.back().t, run.outcome.status.time);
  }
}

inline void expect_helped(const Scene& scene, const Settings& settings) {
  const Recorded r = run(scene, settings);
  EXPECT_TRUE(r.outcome.status.ok()) << r.outcome.status.message;
  ASSERT_FALSE(r.samples.empty());
  EXPECT_NEAR(r.samples.back().t, settings.end, 1e-12 * settings.end);
}

}  // namespace poinsot::test
