#include "bench/report/origin.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>

#include "bench/report/html.h"

namespace poinsot::report {
using namespace study;
namespace {

constexpr std::array<std::string_view, 4> kOrigin{"processor", "program", "compiler", "libraries"};

std::string incomplete_block(const Results& results) {
  std::string html;
  for (const auto& [name, table] : results.tables)
    if (const std::string why = table.note("incomplete"); !why.empty())
      html += fmt::format("<li>{}: {}</li>\n", link(name + ".csv", name + ".csv"), escape(why));
  return html.empty() ? "" : fmt::format("<p class=\"missing\">Incomplete:</p>\n<ul>{}</ul>\n", html);
}

std::string quick_block(const Results& results) {
  std::vector<std::string> files;
  for (const auto& [name, table] : results.tables)
    if (table.note("settings").find("--quick") != std::string::npos) files.push_back(name + ".csv");
  for (const StudyResults& study : results.studies)
    if (study.quick) files.push_back(study.folder + "cases.csv");
  for (std::string& file : files) file = link(file, file);
  return files.empty() ? ""
                       : fmt::format("<p class=\"missing\">Made with --quick, in a reduced form: {}</p>\n",
                                     fmt::join(files, ", "));
}

}  // namespace

std::vector<std::pair<std::string, std::string>> origins(const Results& results) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string_view key : kOrigin) {
    std::map<std::string, std::vector<std::string>> files;
    for (const auto& [name, table] : results.tables)
      if (const std::string value = table.note(key); !value.empty()) files[value].push_back(name);
    std::vector<std::pair<std::string, std::vector<std::string>>> sorted(files.begin(), files.end());
    std::ranges::stable_sort(sorted, std::greater(), [](const auto& one) { return one.second.size(); });
    for (const auto& [value, of] : sorted)
      all.emplace_back(key,
                       &value == &sorted.front().first ? value : fmt::format("{} (of {})", value, fmt::join(of, ", ")));
  }
  return all;
}

std::string origin_block(const Results& results) {
  std::string html = "<dl>\n";
  for (const auto& [key, value] : origins(results))
    html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape(key), escape(value));
  if (const CsvTable* raw = results.find("raw"))
    for (const char* key : {"settings", "timing"})
      html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", key, escape(raw->note(key)));
  return html + "</dl>\n";
}

std::string reservations_block(const Results& results) {
  return incomplete_block(results) + quick_block(results);
}

}  // namespace poinsot::report
