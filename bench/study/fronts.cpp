#include "bench/study/fronts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/input_error.h"

namespace poinsot::study {
namespace fs = std::filesystem;
namespace {

// The fronts of whatever `counts` picks among the rows.
struct OnFronts {
  std::vector<std::string> names;
  std::array<int, kQuantities.size()> on{};
  std::vector<std::string> scenes;
};

template <class Counts>
OnFronts standing(std::vector<std::string> names, const std::vector<SceneChart>& charts, const Counts& counts) {
  OnFronts s{std::move(names), {}, {}};
  for (const SceneChart& chart : charts) {
    std::array<bool, kQuantities.size()> here{};
    for (const ChartRow& row : chart.rows)
      for (std::size_t k = 0; k < here.size() && counts(row); ++k) here[k] = here[k] || row.front[k];
    for (std::size_t k = 0; k < here.size(); ++k) s.on[k] += here[k];
    if (std::ranges::count(here, true) > 0) s.scenes.push_back(chart.scene);
  }
  return s;
}

// In the order of the integrators; those no chart has a row of are left out, they refuse all formulations asked for.
std::vector<OnFronts> of_integrators(const std::vector<std::string>& integrators,
                                     const std::vector<SceneChart>& charts) {
  std::vector<OnFronts> all;
  for (const std::string& name : integrators) {
    const auto its = [&](const ChartRow& row) { return row.integrator == name; };
    if (std::ranges::any_of(charts, [&](const SceneChart& chart) { return std::ranges::any_of(chart.rows, its); }))
      all.push_back(standing({name}, charts, its));
  }
  return all;
}

std::vector<std::string> method_of(const ChartRow& row) {
  return {row.integrator, row.formulation, row.linear_solver};
}

// In the same order and with the same omission.
std::vector<OnFronts> of_methods(const std::vector<std::string>& integrators, const std::vector<SceneChart>& charts) {
  std::vector<std::vector<std::string>> methods;
  for (const std::string& name : integrators)
    for (const SceneChart& chart : charts)
      for (const ChartRow& row : chart.rows)
        if (row.integrator == name && std::ranges::find(methods, method_of(row)) == methods.end())
          methods.push_back(method_of(row));
  std::vector<OnFronts> all;
  for (const auto& method : methods)
    all.push_back(standing(method, charts, [&](const ChartRow& row) { return method_of(row) == method; }));
  return all;
}

Table table(std::string file, std::string title, std::vector<std::string> header, const std::vector<OnFronts>& all) {
  for (const auto quantity : kQuantities) header.emplace_back(quantity);
  header.insert(header.end(), {"any", "scenes"});
  Table table{std::move(file), std::move(title), {}, std::move(header)};
  for (const OnFronts& s : all) {
    std::vector<std::string> row = s.names;
    for (const int n : s.on) row.push_back(std::to_string(n));
    row.push_back(std::to_string(s.scenes.size()));
    row.push_back(fmt::format("{}", fmt::join(s.scenes, " ")));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::vector<SceneChart> charts_before(const fs::path& folder, const std::vector<SceneChart>& anew,
                                      std::vector<std::string>& notices) {
  std::set<fs::path> files;  // in order, whatever the folder's
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".csv" && entry.is_regular_file() && is_chart(entry.path()) &&
        std::ranges::find(anew, entry.path().stem().string(), &SceneChart::scene) == anew.end())
      files.insert(entry.path());
  std::vector<SceneChart> charts;
  for (const fs::path& file : files) {
    try {
      const CsvTable table = read_csv(file);
      if (const std::string why = table.note("incomplete"); !why.empty())
        throw InputError(fmt::format("{}: incomplete: {}", file.string(), why));
      std::vector<ChartRow> rows = chart_rows(table);
      const PerQuantity agreement = chart_agreement(rows);
      const std::string motion = table.note("motion");
      if (motion.empty())
        throw InputError(fmt::format("{}: it does not say whether drivers prescribe the motion", file.string()));
      charts.push_back({file.stem().string(), std::move(rows), agreement, motion == kPrescribed});
    } catch (const InputError& torn) {
      notices.push_back(fmt::format("left out of fronts.md: {}", torn.what()));
    }
  }
  return charts;
}

Report fronts_report(const std::vector<std::string>& integrators, const std::vector<SceneChart>& charts,
                     const std::vector<std::string>& foot) {
  Report report;
  report.title = "Fronts";
  report.text = fmt::format(
      "On how many of {} charts a method is on the front of a quantity: there its curve of time over accuracy is below "
      "all others by more than the noise of the times. "
      "`any`: on the front of one of them at least, in the scenes named.",
      charts.size());
  report.tables = {choice_table(charts),
                   table("fronts_integrators", "Integrators, in any formulation", {"integrator"},
                         of_integrators(integrators, charts)),
                   table("fronts_methods", "Integrators and formulations",
                         {"integrator", "formulation", "linear_solver"}, of_methods(integrators, charts))};
  report.foot = foot;
  return report;
}

std::string fronts_summary(const std::vector<std::string>& integrators, const std::vector<SceneChart>& charts) {
  std::string text =
      fmt::format("on the front of so many of {} chart{}:\n{:44}", charts.size(), charts.size() == 1 ? "" : "s", "");
  for (const auto quantity : kQuantities) text += fmt::format("{:>14}", quantity);
  text += fmt::format("{:>14}\n", "any");
  for (const OnFronts& s : of_methods(integrators, charts)) {
    if (s.scenes.empty()) continue;
    text += fmt::format("  {:42}", fmt::format("{}", fmt::join(s.names, " ")));
    for (const int n : s.on) text += fmt::format("{:>14}", n);
    text += fmt::format("{:>14}\n", s.scenes.size());
  }
  std::vector<std::string> none;
  for (const OnFronts& s : of_integrators(integrators, charts))
    if (s.scenes.empty()) none.push_back(s.names.front());
  if (!none.empty()) text += fmt::format("on no front: {}\n", fmt::join(none, ", "));
  return text;
}

}  // namespace poinsot::study
