#include "bench/report/findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/paper/cell_rows.h"
#include "bench/study/motion.h"
#include "formulations/registry.h"
#include "integrators/settings.h"

namespace poinsot::report {
using namespace study;
using paper::kSubject;
namespace {

std::vector<const Ratio*> pick(const std::vector<Ratio>& all, Analysis analysis, const std::string& formulation,
                               std::string_view jacobian) {
  std::vector<const Ratio*> picked;
  for (const Ratio& r : all)
    if (r.analysis == paper::analysis_name(analysis) && r.formulation == formulation && r.jacobian == jacobian)
      picked.push_back(&r);
  return picked;
}

// "dynamics: rp takes 1.31 to 1.43 times as long as rA (...); in the paper 2.29 to 2.93".
std::string ratio_sentence(const std::vector<const Ratio*>& own, const std::string& other, bool with_paper,
                           Ledger& ledger) {
  const std::string& analysis = own.front()->analysis;
  Range medians, within, paper;
  double confidence = 1;
  std::size_t apart = 0;
  for (const Ratio* r : own) {
    medians.add(r->over.median);
    within.add(r->over.low), within.add(r->over.high);
    confidence = std::min(confidence, r->over.confidence);
    apart += r->over.above(1);
    for (const double x : {r->paper_c1, r->paper_c2})
      if (x > 0) paper.add(x);
  }
  const auto what = [&](const char* name) { return fmt::format("{}, {}: {}", analysis, other, name); };
  std::string text = fmt::format(
      "{}: {} takes {} times as long as {} (medians of {} mechanisms; their intervals, of at least {} % "
      "confidence, lie within {}); it is slower beyond the noise in {} of them.",
      analysis, other, ledger.range(what("ratio"), medians, 2), kSubject, ledger.count(what("mechanisms"), own.size()),
      ledger.number(what("confidence of the intervals, %"), std::floor(1000 * confidence) / 10, 1),
      ledger.range(what("intervals"), within, 2), ledger.count(what("slower beyond the noise"), apart));
  if (with_paper && !paper.empty()) {
    text += fmt::format(" In the paper: {}", ledger.range(what("paper"), paper, 2));
    text += within.low >= paper.low && within.high <= paper.high ? ", which these confirm."
            : within.high < paper.low                            ? ", more than any of these."
            : within.low > paper.high                            ? ", less than any of these."
                                                                 : ", which these reach in part.";
  }
  return text;
}

Finding with_matrix(const std::vector<Ratio>& all, const std::string& id, const std::string& title,
                    const std::string& jacobian, bool like_for_like, Ledger& ledger) {
  Finding finding{id, title};
  ledger.begin(id);
  for (const Analysis analysis : {Analysis::dynamics, Analysis::kinematics})
    for (const std::string& other : other_formulations()) {
      const std::vector<const Ratio*> own = pick(all, analysis, other, jacobian);
      if (!own.empty()) finding.sentences.push_back(ratio_sentence(own, other, like_for_like, ledger));
    }
  return finding;
}

Finding phases(const std::vector<Ratio>& all, Ledger& ledger) {
  Finding finding{"phases", "Why: in which phase the time lies"};
  ledger.begin(finding.id);
  for (const std::string& other : other_formulations()) {
    std::array<double, kPhases.size()> saved{};
    const std::vector<const Ratio*> own = pick(all, Analysis::dynamics, other, paper::kLikeForLike);
    for (const Ratio* r : own)
      for (std::size_t k = 0; k < saved.size(); ++k) saved[k] += r->saved[k];
    double sum = 0;
    for (const double x : saved) sum += x;
    if (own.empty()) continue;
    if (!(sum > 0)) {
      finding.sentences.push_back(
          fmt::format("{} saves no time against {} in dynamics like for like, over all mechanisms.", kSubject, other));
      continue;
    }
    std::vector<std::string> shares;
    for (std::size_t k = 0; k < saved.size(); ++k)
      shares.push_back(fmt::format(
          "{} % in {}", ledger.number(fmt::format("{}: share of {}, %", other, kPhases[k]), 100 * saved[k] / sum, 0),
          kPhases[k]));
    finding.sentences.push_back(fmt::format(
        "Of the time that {} saves against {} in dynamics like for like, over all mechanisms, {}. A negative share is "
        "time that it loses there.",
        kSubject, other, fmt::join(shares, ", ")));
  }
  return finding;
}

Finding matched(const Table& table, Ledger& ledger) {
  Finding finding{"matched", fmt::format("At matched error: {} against the others", kSubject)};
  ledger.begin(finding.id);
  for (const std::string& other : other_formulations())
    for (const std::size_t quantity : {std::size_t{0}, kQuantities.size() - 1}) {
      std::vector<double> ratios;
      std::size_t slower = 0, faster = 0;
      for (const auto& row : table.rows) {
        if (row[2] != other || row[3] != kQuantities[quantity]) continue;
        const double ratio = csv_number(row[5]), noise = 1 + csv_number(row[6]) / 100;
        ratios.push_back(ratio);
        slower += ratio > noise;
        faster += ratio * noise < 1;
      }
      if (ratios.empty()) continue;
      std::sort(ratios.begin(), ratios.end());
      const auto what = [&](const char* name) { return fmt::format("{}, {}: {}", other, kQuantities[quantity], name); };
      Range middle;
      middle.add(ratios[ratios.size() / 4]);
      middle.add(ratios[ratios.size() - 1 - ratios.size() / 4]);
      finding.sentences.push_back(fmt::format(
          "At the same error in {} and with the same integrator {} takes {} times as long as {} in the median of {} "
          "{} (the middle half: {}); beyond the noise it is slower in {} and faster in {}.",
          kQuantities[quantity], other, ledger.number(what("ratio"), median_interval(ratios).median, 2), kSubject,
          ledger.count(what("comparisons"), ratios.size()), ratios.size() == 1 ? "comparison" : "comparisons",
          ledger.range(what("middle half"), middle, 2), ledger.count(what("slower"), slower),
          ledger.count(what("faster"), faster)));
    }
  return finding;
}

// Of studies that compare the formulations: geometric means over their cases, as bench/cases/pictures.h makes them.
Finding studies(const std::vector<StudyResults>& all, Ledger& ledger) {
  Finding finding{"studies", fmt::format("Beyond the paper's mechanisms: {} against the others", kSubject)};
  ledger.begin(finding.id);
  std::string confidence;
  for (const StudyResults& study : all)
    for (const StudyPicture& picture : study.pictures) {
      if (picture.by != "formulation" || picture.to != kSubject) continue;
      const CsvTable& t = picture.numbers;
      const std::array columns{t.column(picture.by), t.column("cases"), t.column("ratio"), t.column("from"),
                               t.column("to")};
      if (std::ranges::min(columns) < 0) continue;
      for (const auto& row : t.rows) {
        const auto field = [&](std::size_t k) -> const std::string& {
          return row[static_cast<std::size_t>(columns[k])];
        };
        if (confidence.empty()) confidence = ledger.text("confidence of the intervals, %", "95");
        const auto said = [&](const char* what, std::size_t k) {
          return ledger.text(fmt::format("{}, {}, {}: {}", study.name, picture.title, field(0), what), field(k));
        };
        finding.sentences.push_back(
            fmt::format("{}; {}: {} {}, {} % interval {} to {} (geometric mean of {} cases{}), {}.", study.name,
                        picture.title, field(0), said("ratio", 2), confidence, said("from", 3), said("to", 4),
                        said("cases", 1), study.incomplete ? " of an incomplete study" : "",
                        csv_number(field(3)) > 1   ? "above one beyond chance"
                        : csv_number(field(4)) < 1 ? "below one beyond chance"
                                                   : "not to be told from one"));
      }
    }
  return finding;
}

Finding choices(const std::vector<const CsvTable*>& charts) {
  Finding finding{"choice", "Which method for which accuracy"};
  for (const CsvTable* chart : charts)
    for (const auto quantity : {kQuantities.front(), kQuantities.back()})
      if (const std::string said = chart->note(fmt::format("conclusion, {}", quantity)); !said.empty())
        finding.sentences.push_back(fmt::format("{}: {}.", chart->file, said));
  return finding;
}

}  // namespace

std::vector<std::string> other_formulations() {
  std::vector<std::string> names = formulations().names();
  std::erase(names, kSubject);
  return names;
}

Findings findings(const Results& results) {
  Findings found;
  Ledger ledger;
  const auto keep = [&](Finding finding, const char* command, const char* within = "") {
    if (finding.sentences.empty())
      found.missing.push_back(
          fmt::format("{}: poinsot {} --out {}{}", finding.title, command, results.folder.string(), within));
    else
      found.all.push_back(std::move(finding));
  };
  const CsvTable* raw = results.find("raw");
  const std::vector<Ratio> all = raw ? ratios(*raw) : std::vector<Ratio>();
  keep(with_matrix(all, "like_for_like", fmt::format("Like for like: how much faster {} is", kSubject),
                   paper::kLikeForLike, true, ledger),
       "tables");
  keep(with_matrix(all, "exact", "With the exact Newton matrix", Settings{}.jacobian, false, ledger), "tables");
  keep(phases(all, ledger), "tables");
  const std::vector<const CsvTable*> charts = results.charts();
  const Table at_matched_error = matched_table(charts);
  keep(matched(at_matched_error, ledger), "chart --all --quick");
  keep(claims(results, all, ledger), "tables");
  keep(studies(results.studies, ledger), "study bench/studies/random_mechanisms.json", "/random_mechanisms");
  keep(choices(charts), "chart --all --quick");
  if (!all.empty()) found.tables.push_back(ratios_table(all));
  if (!at_matched_error.rows.empty()) found.tables.push_back(at_matched_error);
  if (!ledger.table().rows.empty()) found.tables.push_back(ledger.table());
  return found;
}

}  // namespace poinsot::report
