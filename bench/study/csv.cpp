#include "bench/study/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/input_error.h"
#include "core/json_document.h"

namespace poinsot::study {
namespace {

// What a spreadsheet would compute: no sign of a number, nor a dash alone.
bool is_formula(std::string_view text) {
  if (text.starts_with('=') || text.starts_with('@')) return true;
  const bool sign = text.starts_with('+') || text.starts_with('-');
  double number = 0;
  return sign && text.size() > 1 &&
         std::from_chars(text.data() + 1, text.data() + text.size(), number).ptr != text.data() + text.size();
}

}  // namespace

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos && !is_formula(text)) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + '"';
}

std::vector<std::string> csv_fields(std::string_view line) {
  std::vector<std::string> result(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"')
      result.back() += line[++k];
    else if (line[k] == '"')
      quoted = !quoted;
    else if (line[k] == ',' && !quoted)
      result.emplace_back();
    else
      result.back() += line[k];
  }
  return result;
}

int CsvTable::column(std::string_view name) const {
  const auto it = std::find(header.begin(), header.end(), name);
  return it == header.end() ? -1 : static_cast<int>(it - header.begin());
}

std::string CsvTable::note(std::string_view key) const {
  for (const std::string& line : notes)
    if (line.starts_with(key) && std::string_view(line).substr(key.size()).starts_with(": "))
      return line.substr(key.size() + 2);
  return {};
}

CsvTable read_csv(const std::filesystem::path& file) {
  std::ifstream in = open_input(file.string());
  CsvTable table{file.stem().string(), {}, {}, {}};
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.starts_with("#")) {
      table.notes.push_back(line.starts_with("# ") ? line.substr(2) : line.substr(1));
    } else if (table.header.empty()) {
      table.header = csv_fields(line);
    } else if (!line.empty()) {
      table.rows.push_back(csv_fields(line));
      if (table.rows.back().size() != table.header.size())
        throw InputError(fmt::format("{}: line {}: found {} fields, expected {}; {}", file.string(), number,
                                     table.rows.back().size(), table.header.size(), kTornRemedy));
    }
  }
  if (table.header.empty())
    throw InputError(fmt::format("{}: found no header, expected a table; {}", file.string(), kTornRemedy));
  return table;
}

double csv_number(std::string_view field) {
  double x = std::numeric_limits<double>::quiet_NaN();
  const auto read = std::from_chars(field.data(), field.data() + field.size(), x);
  return read.ptr == field.data() + field.size() ? x : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace poinsot::study
