// How much longer the other formulations take than rA, from every repetition of `poinsot tables` (raw.csv).
//
// Repetitions are interleaved, so that what disturbs the machine disturbs cells alike: the k-th of one is divided by
// the k-th of the other, and the median of the quotients is given with its interval (bench/study/interval.h).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bench/report/raw_cells.h"
#include "bench/study/csv.h"
#include "bench/study/interval.h"
#include "bench/study/report.h"

namespace poinsot::report {

struct Ratio {
  std::string analysis, mechanism, formulation, jacobian;
  study::Interval over;               // its time over rA's
  std::array<double, 4> saved{};      // µs a step, by phase: median of the differences
  double paper_c1 = 0, paper_c2 = 0;  // of the same quotient in the paper's speed-ups; 0: it has none
};

// Of the linear solver that the paper's tables were measured with. Nothing where the table is not raw.csv.
std::vector<Ratio> ratios(const study::CsvTable& raw);
// report_ratios.csv
study::Table ratios_table(const std::vector<Ratio>& all);

}  // namespace poinsot::report
