// The report: one HTML file that asks nothing of a network, and beside it the tables computed for it.
//
// Findings first, then the paper's tables and figures by its own numbers, then what the paper has not. Every number in
// it stands in a CSV file of the folder.
#pragma once

#include <string>
#include <vector>

#include "bench/report/results.h"
#include "bench/study/report.h"

namespace poinsot::report {

struct Page {
  std::string html;
  std::vector<study::Table> tables;  // report_*.csv, to be written beside it
  std::vector<std::string> foot;     // of them
};

Page page(const Results& results);

}  // namespace poinsot::report
