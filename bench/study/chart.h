// A work-precision chart of one scene: the cases of a plan measured against a reference, level by level, kept in a file
// (chart_file.h) from which an interrupted sweep goes on.
#pragma once

#include <string>
#include <vector>

#include "bench/study/chart_file.h"
#include "bench/study/progress.h"
#include "bench/study/sweep.h"

namespace poinsot::study {

// Where the numbers of a chart come from, a line each. `core`: as pin_to_one_core() returns it.
std::vector<std::string> chart_notes(const Scene& scene, double end, const Reference& reference, const SweepPlan& plan,
                                     int core);

// Measures what the file does not hold yet, and finds the front.
void measure_chart(const Scene& scene, double end, const Reference& reference, const SweepPlan& plan, ChartFile& file,
                   const ProgressCallback& progress);

}  // namespace poinsot::study
