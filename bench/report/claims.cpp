// The paper's claims, each held against the numbers of a folder.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "bench/paper/cell_rows.h"
#include "bench/report/findings.h"

namespace poinsot::report {
using namespace study;
using paper::kSubject;
namespace {

enum class Verdict { holds, fails, open };

// A claim of the paper, and whether the numbers bear it out.
std::string claim(const std::string& said, Verdict verdict, const std::string& found) {
  const char* words[] = {"It holds", "It does not hold", "These measurements leave it open"};
  return fmt::format("The paper: {}. {}: {}.", said, words[static_cast<int>(verdict)], found);
}
Verdict verdict(bool holds) {
  return holds ? Verdict::holds : Verdict::fails;
}

Verdict of_counts(std::size_t faster, std::size_t slower, std::size_t count) {
  return faster == count ? Verdict::holds : slower > 0 ? Verdict::fails : Verdict::open;
}

// Most over least of a column, by mechanism.
void add_ratios(const CsvTable& table, const std::string& name, Range& ratios) {
  const int column = table.column(name);
  if (column < 0) return;
  std::map<std::string, Range> by_mechanism;
  for (const auto& row : table.rows)
    if (const double x = csv_number(row[static_cast<std::size_t>(column)]); x > 0) by_mechanism[row[0]].add(x);
  for (const auto& [mechanism, range] : by_mechanism) ratios.add(range.high / range.low);
}

std::optional<std::string> claim_of_iterations(const Results& results, Ledger& ledger) {
  Range ours, theirs;
  for (const Analysis analysis : {Analysis::kinematics, Analysis::dynamics}) {
    const CsvTable* table = results.find(paper::file_name(analysis, "iterations"));
    if (!table) continue;
    add_ratios(*table, fmt::format("ours, {}", paper::kLikeForLike), ours);
    for (const char* code : {"paper C1", "paper C2", "C1", "C2"}) add_ratios(*table, code, theirs);
  }
  if (ours.empty() || theirs.empty()) return {};
  return claim("the formulations need comparably many iterations", verdict(ours.high <= theirs.high),
               fmt::format("of a mechanism, the most over the least is {} with the {} matrix, {} in the original codes",
                           ledger.range("iterations, most over least", ours, 2), paper::kLikeForLike,
                           ledger.range("iterations, most over least, original codes", theirs, 2)));
}

std::optional<std::string> claim_of_order(const Results& results, Ledger& ledger) {
  const CsvTable* table = results.find("order_paper_table");
  const int column = table ? table->column("exponent") : -1;
  if (column < 0) return {};
  Range exponents;
  for (const auto& row : table->rows) exponents.add(csv_number(row[static_cast<std::size_t>(column)]));
  return claim("implicit Euler is of first order in all formulations",
               verdict(std::lround(exponents.low) == 1 && std::lround(exponents.high) == 1),
               fmt::format("the exponents of its coordinates are {}; positions are prescribed there, so that this says "
                           "nothing of the equations of motion",
                           ledger.range("exponents", exponents, 3)));
}

std::optional<std::string> claim_of_deltas(const Results& results, Ledger& ledger) {
  const CsvTable* table = results.find("solution_deltas_table");
  const int column = table ? table->column("from rA, %") : -1;
  if (column < 0) return {};
  std::map<std::string, Range> by_formulation;
  for (const auto& row : table->rows) by_formulation[row[0]].add(csv_number(row[static_cast<std::size_t>(column)]));
  std::vector<std::string> parts;
  double most = 0;
  for (const std::string& other : other_formulations()) {
    const auto it = by_formulation.find(other);
    if (it == by_formulation.end()) continue;
    most = std::max(most, it->second.high);
    parts.push_back(fmt::format(
        "{} by up to {} %", other,
        ledger.text(fmt::format("{}: difference of the solutions, %", other), fmt::format("{:.1g}", it->second.high))));
  }
  if (parts.empty()) return {};
  return claim("the solutions of the double pendulum are nearly identical", verdict(most < 1),
               fmt::format("errors differ from those of {}: {}", kSubject, fmt::join(parts, ", ")));
}

std::optional<std::string> claim_of_linear_systems(const Results& results, Ledger& ledger) {
  const CsvTable* table = results.find(paper::file_name(Analysis::dynamics, "phases"));
  if (!table) return {};
  const int total = table->column("total"), factor = table->column("factorization"), solve = table->column("solves"),
            jacobian = table->column("jacobian");
  if (std::min({total, factor, solve, jacobian}) < 0) return {};
  Range shares;
  for (const auto& row : table->rows) {
    const auto at = [&](int column) { return csv_number(row[static_cast<std::size_t>(column)]); };
    if (row[static_cast<std::size_t>(jacobian)] == paper::kLikeForLike && at(total) > 0)
      shares.add(100 * (at(factor) + at(solve)) / at(total));
  }
  if (shares.empty()) return {};
  return claim("solving the linear systems is a critical bottleneck", verdict(shares.high > 50),
               fmt::format("factorizations and solves take {} % of a step in compiled code",
                           ledger.range("share of the linear systems, %", shares, 0)));
}

std::optional<std::string> claim_of_reps(const std::vector<Ratio>& all, Ledger& ledger) {
  const std::string baseline = other_formulations().front(), other = other_formulations().back();
  Range quotient;
  std::size_t faster = 0, slower = 0, count = 0;
  for (const Ratio& one : all) {
    if (one.formulation != baseline || one.jacobian != paper::kLikeForLike) continue;
    for (const Ratio& two : all) {
      if (two.analysis != one.analysis || two.mechanism != one.mechanism || two.jacobian != one.jacobian ||
          two.formulation != other)
        continue;
      const double x = one.over.median / two.over.median;
      quotient.add(x);
      faster += two.over.decides() && one.over.above(two.over.high);
      slower += two.over.decides() && one.over.below(two.over.low);
      ++count;
    }
  }
  if (count == 0) return {};
  return claim(
      fmt::format("{} is faster than {}", other, baseline), of_counts(faster, slower, count),
      fmt::format("{} takes {} times as long as {}; of {} comparisons {} is the faster one beyond the noise in {}, "
                  "the slower one in {}",
                  baseline, ledger.range("ratio of the two", quotient, 2), other, ledger.count("comparisons", count),
                  other, ledger.count("faster beyond the noise", faster),
                  ledger.count("slower beyond the noise", slower)));
}

std::optional<std::string> claim_of_subject(const std::vector<Ratio>& all, Ledger& ledger) {
  std::size_t faster = 0, slower = 0, count = 0;
  for (const Ratio& r : all)
    if (r.jacobian == paper::kLikeForLike) ++count, faster += r.over.above(1), slower += r.over.below(1);
  if (count == 0) return {};
  return claim(fmt::format("{} is the fastest", kSubject), of_counts(faster, slower, count),
               fmt::format("of {} comparisons like for like it is faster beyond the noise in {} and slower in {}",
                           ledger.count("comparisons of all", count), ledger.count("faster than others", faster),
                           ledger.count("slower than others", slower)));
}

}  // namespace

Finding claims(const Results& results, const std::vector<Ratio>& all, Ledger& ledger) {
  Finding finding{"claims", "Where the paper's claims hold"};
  ledger.begin(finding.id);
  for (const auto& said :
       {claim_of_subject(all, ledger), claim_of_reps(all, ledger), claim_of_iterations(results, ledger),
        claim_of_order(results, ledger), claim_of_deltas(results, ledger), claim_of_linear_systems(results, ledger)})
    if (said) finding.sentences.push_back(*said);
  return finding;
}

}  // namespace poinsot::report
