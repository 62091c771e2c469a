// A folder of results: the tables that `poinsot tables`, `figures`, `scale` and `chart` left there, and studies.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/report/studies.h"
#include "bench/study/csv.h"

namespace poinsot::report {

// What this library writes itself begins so and is no result.
inline constexpr std::string_view kOwn = "report_";

struct Results {
  std::filesystem::path folder;
  std::map<std::string, study::CsvTable> tables;  // by the name of the file, without extension
  std::vector<StudyResults> studies = {};

  const study::CsvTable* find(const std::string& name) const;  // nullptr where there is none
  std::vector<const study::CsvTable*> charts() const;
};

// Throws InputError where it is no folder, holds no table, or a table in it cannot be read.
Results read_results(const std::filesystem::path& folder);

}  // namespace poinsot::report
