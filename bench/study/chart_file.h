// The CSV of a work-precision chart: notes on where the numbers come from, a row per case, the front at the end.
//
// Rows are appended as they are measured, so that an interrupted sweep goes on where it stopped. The notes come first
// and must be the same then: numbers of two programs, machines or settings do not stand in one file. Until the sweep is
// finished a note after them says that it is not. Columns: the case
// (formulation, integrator, linear_solver, parameter, value), its status ("ok", "reference" for how far the reference
// can be trusted, or why there are no figures), errors of the four quantities, constraint violation, energy drift,
// seconds and their spread, counts, and by quantity whether the case is on the front (1, 0). Below the rows stands, by
// quantity, what follows for the accuracies (cost_curve.h).
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "bench/study/csv.h"
#include "bench/study/sweep.h"

namespace poinsot::study {

// What the note "motion" says of the scene.
inline constexpr std::string_view kPrescribed = "drivers prescribe all positions", kFree = "free";

struct ChartRow {
  std::string formulation, integrator, linear_solver, parameter;
  double value = 0;
  Measured measured = {};
  std::array<bool, kQuantities.size()> front{};

  bool of(const Case& one) const;
  std::string method() const;
  bool is_reference() const { return measured.status == "reference"; }
};

// Whether a table is a chart, and its rows: that of the reference has its status and no seconds.
bool is_chart(const CsvTable& table);
bool is_chart(const std::filesystem::path& file);  // by its header alone
std::vector<ChartRow> chart_rows(const CsvTable& table);
// Of the cases measured.
std::vector<double> chart_spreads(const std::vector<ChartRow>& rows);
// How far the reference among the rows can be trusted; zeros where there is none.
PerQuantity chart_agreement(const std::vector<ChartRow>& rows);

class ChartFile {
 public:
  // Goes on with what the file holds, or begins it (`fresh`: in any case). Throws InputError where the file holds
  // something else or was measured otherwise.
  ChartFile(std::filesystem::path file, std::vector<std::string> notes, bool fresh);

  const ChartRow* find(const Case& one) const;  // nullptr where it has not been measured
  void add(const Case& one, const Measured& measured);
  // Finds the front and writes the whole file anew.
  void finish(const Reference& reference);

  const std::filesystem::path& path() const { return file_; }
  const std::vector<ChartRow>& rows() const { return rows_; }

 private:
  void read();
  void write_all(const Reference* reference) const;

  std::filesystem::path file_;
  std::vector<std::string> notes_;
  std::vector<ChartRow> rows_;
  std::ofstream out_;
};

}  // namespace poinsot::study
