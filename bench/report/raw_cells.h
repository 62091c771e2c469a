// The cells of raw.csv, which holds every repetition that `poinsot tables` has timed.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "bench/study/csv.h"

namespace poinsot::report {

inline constexpr std::array<std::string_view, 4> kPhases{"assembly", "factorization", "solves", "the rest"};

struct RawCell {
  struct Repetition {
    double total = 0;               // µs a step
    std::array<double, 4> phase{};  // µs a step, by kPhases
  };

  std::string analysis, mechanism, formulation, jacobian, linear_solver;
  int block = 0;                                       // measured once more, beside other linear solvers: 1
  std::map<std::string, Repetition> repetitions = {};  // by number
  std::map<std::string, std::string> counts = {};      // steps, iterations and so on of the first repetition, by column

  std::string name() const;  // of its own in the file
};

// In the order of the file; nothing where the table is not raw.csv.
std::vector<RawCell> raw_cells(const study::CsvTable& raw);

}  // namespace poinsot::report
