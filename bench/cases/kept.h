// What a study keeps of each case: numbers of any column of a run, errors, violations, energy drift, counts, times.
//
//   "keep": ["violation", "energy_drift", "counts", "errors", "notices", "seconds",
//            {"column": "slider.x", "name": "x", "take": ["final", "min", "max", "range"], "at": [0.1, 0.2]}]
//
// gives the columns violation_position, violation_velocity; energy_drift (largest |E − E(0)| over the largest kinetic
// energy; empty where the scene's energy changes); steps, newton_iterations, factorizations; error_position ... against
// a reference (bench/study/reference.h); seconds (median of the repetitions), spread, seconds_assembly ...; x.final,
// x.min, x.max, x.range = max − min, over the output times, x@0.1, x@0.2. Times must be output times; evenly spaced
// ones are {"from": 0, "to": 1, "count": 11}.
#pragma once

#include <string>
#include <vector>

#include "bench/cases/columns.h"
#include "core/json_value.h"
#include "integrators/settings.h"

namespace poinsot::cases {

inline constexpr int kErrorTimes = 20;  // at which errors are taken, where no "every" says others

// A column of which numbers are kept.
struct Quantity {
  std::string name, column;  // name: as the table calls it
  bool final = false, least = false, greatest = false, range = false;
  std::vector<double> at;  // s, ascending
  std::size_t item = 0;    // of "keep", counted from 0
};

struct Kept {
  std::vector<Quantity> quantities;
  bool violation = false, energy_drift = false, counts = false, errors = false, seconds = false;
  bool notices = false;  // what a run that ended well said, in the column of messages
  int digits = 10;       // of the reference that errors are against

  std::vector<std::string> columns() const;
  static std::string at_name(const std::string& quantity, double t);  // "x@0.1"
  std::string text() const;                                           // all there is to it
};

// "keep" of a study. `timed`: whether runs are repeated.
Kept read_kept(const JsonValue& study, bool timed);
// Throws InputError where a scene, called `scene`, has no such column.
Column require_column(const JsonValue& study, const Quantity& quantity, const Model& model, std::string_view scene);
// Throws InputError where a time asked for is not an output time of runs with these settings.
void require_output_times(const JsonValue& study, const Kept& kept, const Settings& settings);

}  // namespace poinsot::cases
