// Signals of a run by column.
#pragma once

#include <map>
#include <optional>

#include "integrators/signals.h"
#include "tests/support/simulation.h"

namespace poinsot::test {

using Columns = std::map<std::string, std::vector<double>>;

inline Columns signals_of(const Scene& scene, Settings settings) {
  settings.signals = true;
  const std::vector<std::string> names = Signals::names(compile(scene));
  Columns columns;
  std::optional<Signals> signals;
  const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
    if (!signals) signals.emplace(sample.problem);
    signals->update(sample);
    ASSERT_EQ(signals->values().size(), names.size());
    columns["t"].push_back(sample.t);
    for (std::size_t k = 0; k < names.size(); ++k) columns[names[k]].push_back(signals->values()[k]);
  });
  EXPECT_TRUE(outcome.status.ok()) << outcome.status.message;
  return columns;
}

}  // namespace poinsot::test
