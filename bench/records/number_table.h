// A table of numbers as a file: CSV, or NumPy's .npy where the name ends so.
//
// CSV has a header line and 17 significant digits: what is read back is what was computed. The .npy (format 1.0) holds
// the same numbers as one array of rows × columns, little-endian float64 in rows ('<f8', C order); the names of the
// columns are in the run record. Its header, of kNpyHeader bytes, says how many rows there are on the disk.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/study/output_file.h"

namespace poinsot::records {

bool is_npy(const std::filesystem::path& file);

class NumberTable {
 public:
  static constexpr std::size_t kNpyHeader = 128;

  explicit NumberTable(const std::filesystem::path& file);                           // throws InputError
  NumberTable(const std::filesystem::path& file, std::vector<std::string> columns);  // begun

  // Before the first number, once. The first column's name is "t" or another that needs no quotes.
  void begin(std::vector<std::string> columns);
  bool begun() const { return !columns_.empty(); }
  const std::vector<std::string>& columns() const { return columns_; }
  void write(double value);  // the next of the row, which ends with the last column
  study::OutputFile& file() { return file_; }

 private:
  study::OutputFile file_;
  const bool npy_;
  std::vector<std::string> columns_;
  std::size_t column_ = 0;  // next
};

}  // namespace poinsot::records
