#include "bench/stability/maps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bench/cases/executor.h"
#include "bench/study/csv.h"
#include "bench/study/output_file.h"
#include "bench/study/plot.h"
#include "core/input_error.h"
#include "core/interruption.h"
#include "formulations/registry.h"
#include "integrators/integrator.h"

namespace poinsot::stability {
using study::Table;
namespace fs = std::filesystem;
namespace {

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "";
}

std::vector<std::string> row_of(const Cell& cell) {
  return {cell.formulation,
          cell.integrator,
          fmt::format("{:g}", cell.x),
          fmt::format("{:g}", cell.y),
          std::string(name(cell.verdict)),
          cell.status,
          number(cell.error),
          number(cell.promised),
          cell.ended() ? fmt::format("{:g}", cell.steps) : "",
          cell.message};
}
const std::vector<std::string> kHeader{"formulation", "integrator", "x",        "y",     "verdict",
                                       "status",      "error",      "promised", "steps", "message"};

// What row_of() tells.
Cell cell_of(const std::vector<std::string>& row, const fs::path& file) {
  int verdict = 0;
  while (verdict < kVerdicts && row[4] != name(static_cast<Verdict>(verdict))) ++verdict;
  if (verdict == kVerdicts)
    throw InputError(
        fmt::format("{}: found \"{}\", expected a verdict; {}", file.string(), row[4], study::kTornRemedy));
  Cell cell;
  cell.verdict = static_cast<Verdict>(verdict);
  cell.formulation = row[0], cell.integrator = row[1], cell.status = row[5], cell.message = row[9];
  cell.x = study::csv_number(row[2]), cell.y = study::csv_number(row[3]);
  cell.error = study::csv_number(row[6]), cell.promised = study::csv_number(row[7]);
  cell.steps = study::csv_number(row[8]);
  return cell;
}

// How a family's cells of one integrator divide, by formulation.
struct Share {
  std::map<std::string, std::array<int, kVerdicts>> by_formulation;

  void add(const Cell& cell) { ++by_formulation[cell.formulation][static_cast<std::size_t>(cell.verdict)]; }
  std::array<int, kVerdicts> all() const {
    std::array<int, kVerdicts> sum{};
    for (const auto& [_, counts] : by_formulation)
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += counts[k];
    return sum;
  }
  static int total(const std::array<int, kVerdicts>& counts) { return std::reduce(counts.begin(), counts.end()); }
  // In which it is accurate wherever it was tried.
  std::vector<std::string> accurate() const {
    std::vector<std::string> names;
    for (const FormulationEntry& entry : formulations())
      if (const auto at = by_formulation.find(std::string(entry.name)); at != by_formulation.end())
        if (at->second[0] == total(at->second)) names.emplace_back(entry.name);
    return names;
  }
};

std::string divided(const std::array<int, kVerdicts>& counts) {
  const int total = Share::total(counts);
  std::string text = fmt::format("{} of {}", counts[0], total);
  std::vector<std::string> others;
  for (std::size_t k = 1; k < counts.size(); ++k)
    if (counts[k] > 0) others.push_back(fmt::format("{} {}", counts[k], name(static_cast<Verdict>(k))));
  return others.empty() ? text : fmt::format("{} ({})", text, fmt::join(others, ", "));
}

}  // namespace

std::vector<Mapped> map_families(const std::vector<const Family*>& families, const Extent& extent,
                                 const Mapping& mapping, const MapsTold& told) {
  double all = 0, done = 0;
  for (const Family* family : families) all += static_cast<double>(FamilyStudy(*family, extent).study().size());
  std::vector<Mapped> maps;
  for (const Family* family : families) {
    const FamilyStudy study(*family, extent);
    const std::int64_t size = study.study().size();
    cases::CaseTable table(study.study());
    const std::filesystem::path part = mapping.folder / fmt::format("{}.part", family->name);
    if (mapping.fresh) std::filesystem::remove(part);
    table.open(part);
    table.read(part, false);
    compute(study, table, mapping.threads > 0 ? mapping.threads : cases::processors(), [&] {
      double there = done;
      for (std::int64_t k = 0; k < size; ++k) there += table.has(k);
      if (told) told(there, all, *family);
    });
    if (interruption_requested) break;
    done += static_cast<double>(size);
    maps.push_back({family, study.cells(table)});
  }
  return maps;
}

int count(const std::vector<Cell>& cells, Verdict verdict) {
  return static_cast<int>(std::ranges::count(cells, verdict, &Cell::verdict));
}

std::vector<Mapped> maps_before(const fs::path& folder, const std::vector<const Family*>& anew,
                                std::vector<std::string>& notices) {
  std::vector<Mapped> maps;
  for (const Family& family : families()) {
    const fs::path file = folder / fmt::format("{}.csv", family.name);
    if (std::ranges::find(anew, &family) != anew.end() || !fs::exists(file)) continue;
    try {
      const study::CsvTable table = study::read_csv(file);
      if (table.header != kHeader) continue;  // of something else that is called so
      Mapped map{&family, {}, fs::exists(folder / fmt::format("{}.svg", family.name))};
      for (const auto& row : table.rows) map.cells.push_back(cell_of(row, file));
      maps.push_back(std::move(map));
    } catch (const InputError& torn) {
      notices.push_back(fmt::format("left out of stability.md: {}", torn.what()));
    }
  }
  return maps;
}

std::string write_maps(std::vector<Mapped>& maps, const fs::path& directory, const std::vector<std::string>& foot) {
  std::vector<study::Plot> plots;
  for (const Mapped& map : maps) {
    const Family& family = *map.family;
    Table table{std::string(family.name), std::string(family.title), "", kHeader, {}};
    for (const Cell& cell : map.cells) table.rows.push_back(row_of(cell));
    std::vector<std::string> notes{fmt::format("title: {}", family.title), fmt::format("about: {}", family.about),
                                   fmt::format("x: {}", family.x.label), fmt::format("y: {}", family.y.label)};
    notes.insert(notes.end(), foot.begin(), foot.end());
    study::OutputFile file(directory / (table.file + ".csv"));
    file.write(study::csv(table, notes));
    file.commit();
    plots.push_back({file.target(), directory / table.file});
  }
  const std::string why = study::draw("maps", plots);
  for (Mapped& map : maps) map.drawn = why.empty();
  return why;
}

std::vector<Table> tables(const std::vector<Mapped>& maps) {
  Table verdicts{"stability_verdicts", "Verdicts", "Cells of each family by what became of them.", {"family"}, {}};
  for (int k = 0; k < kVerdicts; ++k) verdicts.header.emplace_back(name(static_cast<Verdict>(k)));
  verdicts.header.emplace_back("cells");
  Table use{"stability_use",
            "Which method near which edge",
            "Methods that were accurate in every cell of a family, and how the cells of the others divide.",
            {"edge", "accurate throughout", "the others: accurate cells of all"},
            {}};
  Table doubtful{"stability_doubtful",
                 "Results that are not what was promised",
                 "Silently wrong ones, and those that the run itself doubts.",
                 {"family"},
                 {}};
  doubtful.header.insert(doubtful.header.end(), kHeader.begin(), kHeader.end());
  std::array<int, kVerdicts> sum{};
  for (const Mapped& map : maps) {
    std::vector<std::string> row{std::string(map.family->name)};
    for (int k = 0; k < kVerdicts; ++k) {
      const int n = count(map.cells, static_cast<Verdict>(k));
      sum[static_cast<std::size_t>(k)] += n;
      row.push_back(fmt::format("{}", n));
    }
    row.push_back(fmt::format("{}", map.cells.size()));
    verdicts.rows.push_back(std::move(row));

    std::map<std::string, Share> shares;
    for (const Cell& cell : map.cells) {
      shares[cell.integrator].add(cell);
      if (cell.verdict != Verdict::wrong && cell.verdict != Verdict::told) continue;
      std::vector<std::string> of = row_of(cell);
      of.insert(of.begin(), std::string(map.family->name));
      doubtful.rows.push_back(std::move(of));
    }
    std::vector<std::string> good, others;
    for (const IntegratorEntry& entry : integrators()) {
      const auto at = shares.find(std::string(entry.name));
      if (at == shares.end()) continue;
      const std::vector<std::string> where = at->second.accurate();
      if (where.size() == at->second.by_formulation.size())
        good.emplace_back(entry.name);
      else if (!where.empty())
        good.push_back(fmt::format("{} in {}", entry.name, fmt::join(where, " and ")));
      if (where.size() < at->second.by_formulation.size())
        others.push_back(fmt::format("{} {}", entry.name, divided(at->second.all())));
    }
    use.rows.push_back({std::string(map.family->title), fmt::format("{}", fmt::join(good, ", ")),
                        fmt::format("{}", fmt::join(others, "; "))});
  }
  std::vector<std::string> row{"all"};
  for (const int n : sum) row.push_back(fmt::format("{}", n));
  row.push_back(fmt::format("{}", Share::total(sum)));
  verdicts.rows.push_back(std::move(row));
  return {verdicts, use, doubtful};
}

study::Report stability_report(const std::vector<Mapped>& maps, bool amplification,
                               const std::vector<std::string>& foot) {
  study::Report report{"Where methods fail", "", tables(maps), foot};
  std::string text;
  for (const Mapped& one : maps)
    text += fmt::format("**{}**: {}.\n\n{}", one.family->title, one.family->about,
                        one.drawn ? fmt::format("![{}]({}.svg)\n\n", one.family->title, one.family->name) : "");
  if (amplification) text += "![Spectral radius](amplification.svg)\n\n";
  report.tables.front().text = text + report.tables.front().text;
  return report;
}

}  // namespace poinsot::stability
