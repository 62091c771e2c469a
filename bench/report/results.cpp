#include "bench/report/results.h"

#include <fmt/format.h>

#include "bench/study/chart_file.h"
#include "core/input_error.h"

namespace poinsot::report {
namespace fs = std::filesystem;

const study::CsvTable* Results::find(const std::string& name) const {
  const auto it = tables.find(name);
  return it == tables.end() ? nullptr : &it->second;
}

std::vector<const study::CsvTable*> Results::charts() const {
  std::vector<const study::CsvTable*> all;
  for (const auto& [name, table] : tables)
    if (study::is_chart(table)) all.push_back(&table);
  return all;
}

Results read_results(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError(fmt::format("{}: expected a folder of results", folder.string()));
  Results results{folder, {}, read_studies(folder)};
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == ".csv" && entry.is_regular_file() && !name.starts_with(kOwn))
      results.tables.emplace(name, study::read_csv(entry.path()));
  }
  if (results.tables.empty() && results.studies.empty())
    throw InputError(fmt::format("{}: found no CSV file, expected what `poinsot tables --out {}` writes",
                                 folder.string(), folder.string()));
  return results;
}

}  // namespace poinsot::report
