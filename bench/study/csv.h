// CSV files as the program writes them: fields put together and taken apart, and whole files with their notes, the
// lines that begin with '#'.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace poinsot::study {

// A field of CSV, quoted where it has to be, and where a spreadsheet would take it for a formula.
std::string csv_field(std::string_view text);
std::vector<std::string> csv_fields(std::string_view line);

struct CsvTable {
  std::string file;  // its name, without folder and extension
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  // as long as the header
  std::vector<std::string> notes;              // without "# "

  // Number of the column of this name; -1 where there is none.
  int column(std::string_view name) const;
  // The text of the note "key: text"; empty where there is none.
  std::string note(std::string_view key) const;
};

// What helps where a file was torn.
inline constexpr std::string_view kTornRemedy = "delete the file, or have it written anew";
// Throws InputError where the file cannot be read, has no header, or a row is not as long as it (it was torn).
CsvTable read_csv(const std::filesystem::path& file);

// Not a number where the field holds none.
double csv_number(std::string_view field);

}  // namespace poinsot::study
