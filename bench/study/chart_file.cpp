#include "bench/study/chart_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "bench/study/cost_curve.h"
#include "bench/study/output_file.h"
#include "core/input_error.h"

namespace poinsot::study {
namespace fs = std::filesystem;
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kColumns = 22;
constexpr const char* kUnfinished =
    "# incomplete: the sweep goes on or was interrupted; the same command goes on with it";

std::string header() {
  std::string line = "formulation,integrator,linear_solver,parameter,value,status";
  for (const auto quantity : kQuantities) line += fmt::format(",{}", quantity);
  line += ",violation_position,violation_velocity,energy_drift,seconds,spread,steps,newton_iterations,factorizations";
  for (const auto quantity : kQuantities) line += fmt::format(",front_{}", quantity);
  return line;
}

// Names of scenes and messages of failures have lines of their own in no CSV.
std::string on_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

// Shortest text that is read back as the same number; empty for none.
std::string text(double x) {
  return std::isfinite(x) ? fmt::format("{}", x) : "";
}

std::string line(const ChartRow& row) {
  const Measured& m = row.measured;
  const bool figures = m.ok() || row.is_reference();
  std::vector<std::string> f{row.formulation, row.integrator,  row.linear_solver,
                             row.parameter,   text(row.value), csv_field(m.status)};
  for (const double error : m.error) f.push_back(figures ? text(error) : "");
  for (const double x : {m.violation_position, m.violation_velocity, m.energy_drift, m.seconds, m.spread})
    f.push_back(m.ok() ? text(x) : "");
  for (const std::int64_t n : {m.steps, m.newton_iterations, m.factorizations})
    f.push_back(m.ok() ? std::to_string(n) : "");
  for (const bool on : row.front) f.push_back(m.ok() ? std::to_string(on) : "");
  return fmt::format("{}\n", fmt::join(f, ","));
}

double number(const std::string& field) {
  double x = kNone;
  std::from_chars(field.data(), field.data() + field.size(), x);
  return x;
}

std::int64_t count(const std::string& field) {
  std::int64_t n = 0;
  std::from_chars(field.data(), field.data() + field.size(), n);
  return n;
}

ChartRow row_of(const std::vector<std::string>& f) {
  ChartRow row{f[0], f[1], f[2], f[3], number(f[4])};
  Measured& m = row.measured;
  m.status = f[5];
  for (std::size_t k = 0; k < kQuantities.size(); ++k) m.error[k] = number(f[6 + k]);
  m.violation_position = number(f[10]);
  m.violation_velocity = number(f[11]);
  m.energy_drift = number(f[12]);
  m.seconds = number(f[13]);
  m.spread = number(f[14]);
  m.steps = count(f[15]);
  m.newton_iterations = count(f[16]);
  m.factorizations = count(f[17]);
  for (std::size_t k = 0; k < kQuantities.size(); ++k) row.front[k] = f[18 + k] == "1";
  return row;
}

}  // namespace

bool ChartRow::of(const Case& one) const {
  return formulation == one.settings.formulation && integrator == one.settings.integrator &&
         linear_solver == one.settings.linear_solver && parameter == one.parameter() && value == one.value();
}

std::string ChartRow::method() const {
  const std::string name = fmt::format("{} in {}", integrator, formulation);
  return linear_solver == kUsualSolver ? name : fmt::format("{} with {}", name, linear_solver);
}

std::vector<ChartRow> chart_rows(const CsvTable& table) {
  std::vector<ChartRow> rows;
  if (!is_chart(table)) return rows;
  for (const auto& fields : table.rows) rows.push_back(row_of(fields));
  return rows;
}

std::vector<double> chart_spreads(const std::vector<ChartRow>& rows) {
  std::vector<double> spreads;
  for (const ChartRow& row : rows)
    if (row.measured.ok()) spreads.push_back(row.measured.spread);
  return spreads;
}

PerQuantity chart_agreement(const std::vector<ChartRow>& rows) {
  const auto reference = std::ranges::find_if(rows, &ChartRow::is_reference);
  return reference == rows.end() ? PerQuantity{} : reference->measured.error;
}

bool is_chart(const CsvTable& table) {
  return fmt::format("{}", fmt::join(table.header, ",")) == header();
}

bool is_chart(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string line;
  while (std::getline(in, line) && line.starts_with("#")) {
  }
  return line == header();
}

ChartFile::ChartFile(fs::path file, std::vector<std::string> notes, bool fresh)
    : file_(std::move(file)), notes_(std::move(notes)) {
  for (std::string& note : notes_) note = on_one_line(note);
  if (std::error_code none; !fresh && fs::is_regular_file(file_, none)) read();
  write_all(nullptr);
  out_.open(file_, std::ios::app | std::ios::binary);
}

void ChartFile::read() {
  std::ifstream in(file_, std::ios::binary);
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {}; --fresh begins it anew, another --out keeps it", file_.string(), why));
  };
  std::vector<std::string> lines;
  for (std::string one; std::getline(in, one) && !in.eof();) lines.push_back(one);  // without a last one cut off
  for (std::size_t k = 0; k < notes_.size(); ++k) {
    const std::string expected = "# " + notes_[k];
    if (k >= lines.size() || !lines[k].starts_with("# ")) refuse("the file is not the beginning of this chart");
    if (lines[k] != expected)
      refuse(fmt::format("measured otherwise, there it says \"{}\", now \"{}\"", lines[k].substr(2), notes_[k]));
  }
  std::size_t head = notes_.size();
  if (head < lines.size() && lines[head] == kUnfinished) ++head;
  if (lines.size() <= head || lines[head] != header()) refuse("the file is not the beginning of this chart");
  for (std::size_t k = head + 1; k < lines.size(); ++k) {
    if (lines[k].starts_with("#")) continue;  // a conclusion
    const std::vector<std::string> f = csv_fields(lines[k]);
    if (f.size() != kColumns) refuse(fmt::format("line {} is not a row of a chart", k + 1));
    if (f[5] == "reference") continue;
    rows_.push_back(row_of(f));
    rows_.back().front = {};  // that of all rows is found at the end
  }
}

void ChartFile::write_all(const Reference* reference) const {
  OutputFile file(file_);
  for (const std::string& note : notes_) file.write(fmt::format("# {}\n", note));
  if (!reference) file.write(fmt::format("{}\n", kUnfinished));
  file.write(header() + "\n");
  if (reference) {
    ChartRow row{reference->of().formulation, reference->of().integrator, kUsualSolver, "rtol", reference->of().tight};
    row.measured.status = "reference";
    row.measured.error = reference->agreement;
    file.write(line(row));
  }
  for (const ChartRow& row : rows_) file.write(line(row));
  for (std::size_t k = 0; reference && k < kQuantities.size(); ++k) {
    const std::string said = CostCurves(rows_, k, reference->agreement[k]).conclusion();
    if (!said.empty()) file.write(fmt::format("# conclusion, {}: {}\n", kQuantities[k], said));
  }
  file.commit();
}

const ChartRow* ChartFile::find(const Case& one) const {
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const ChartRow& r) { return r.of(one); });
  return row == rows_.end() ? nullptr : &*row;
}

void ChartFile::add(const Case& one, const Measured& measured) {
  const Settings& s = one.settings;
  rows_.push_back({s.formulation, s.integrator, s.linear_solver, one.parameter(), one.value(), measured});
  rows_.back().measured.status = on_one_line(measured.status);
  out_ << line(rows_.back()) << std::flush;
  if (!out_) throw OutputError(fmt::format("{}: cannot be written: {}", file_.string(), std::strerror(errno)));
}

void ChartFile::finish(const Reference& reference) {
  for (std::size_t quantity = 0; quantity < kQuantities.size(); ++quantity) {
    const std::vector<bool> on = CostCurves(rows_, quantity, reference.agreement[quantity]).front();
    for (std::size_t k = 0; k < rows_.size(); ++k) rows_[k].front[quantity] = on[k];
  }
  out_.close();
  write_all(&reference);
}

}  // namespace poinsot::study
