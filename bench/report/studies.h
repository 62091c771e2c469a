// Studies among the results (bench/cases): in the folder itself, or in folders of it, as `poinsot study FILE --out
// FOLDER/NAME` leaves them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/study/csv.h"
#include "bench/study/report.h"

namespace poinsot::report {

struct StudyPicture {
  std::string title, file;          // the file within the study's folder, without extension
  std::string by, to;               // of a ratio: the setting, and the value of it that the others are compared with
  study::CsvTable points, numbers;  // what is drawn, and the table beside it
};

struct StudyResults {
  std::string folder;  // within that of the results: "", "random_mechanisms/"
  std::string name, about;
  bool incomplete = false, quick = false;  // quick: a tenth of its cases
  std::vector<StudyPicture> pictures;      // those that are there
  std::size_t cases = 0, failed = 0;       // computed, and those of them without a result
  study::CsvTable origin = {};             // nothing but notes, as other tables have them
};

// Throws InputError where a record or a table cannot be read.
std::vector<StudyResults> read_studies(const std::filesystem::path& folder);
// report_studies.csv
study::Table studies_table(const std::vector<StudyResults>& studies);

}  // namespace poinsot::report
