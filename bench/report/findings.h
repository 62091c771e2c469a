// What follows from a folder of results, in sentences made of its numbers.
#pragma once

#include <string>
#include <vector>

#include "bench/report/ledger.h"
#include "bench/report/ratios.h"
#include "bench/report/results.h"

namespace poinsot::report {

struct Finding {
  std::string id, title;
  std::vector<std::string> sentences = {};
};

struct Findings {
  std::vector<Finding> all;          // those there are tables for
  std::vector<study::Table> tables;  // computed for them: report_*.csv
  std::vector<std::string> missing;  // what could not be said, and which command makes it
};

Findings findings(const Results& results);

// All but rA, in the order of the registry.
std::vector<std::string> other_formulations();
// Where the paper's claims hold: of those there are tables for.
Finding claims(const Results& results, const std::vector<Ratio>& all, Ledger& ledger);

// How long other formulations take than rA at the same accuracy, by scene and integrator, from the curves of the
// charts.
study::Table matched_table(const std::vector<const study::CsvTable*>& charts);

}  // namespace poinsot::report
