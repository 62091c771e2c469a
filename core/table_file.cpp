#include "core/table_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "core/input_error.h"
#include "core/json_document.h"
#include "core/printable.h"

namespace poinsot {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Field `column` of a line; none where the line ends before.
std::optional<std::string_view> field(std::string_view line, std::size_t column) {
  for (; column > 0; --column) {
    const std::size_t end = line.find_first_of(",;\t");
    if (end == line.npos) return {};
    line.remove_prefix(end + 1);
  }
  return trimmed(line.substr(0, line.find_first_of(",;\t")));
}

std::optional<double> number(std::optional<std::string_view> text) {
  if (!text) return {};
  if (text->starts_with('+')) text->remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc() || end != text->data() + text->size() || !std::isfinite(value)) return {};
  return value;
}

}  // namespace

std::vector<std::pair<double, double>> read_columns(const std::filesystem::path& file, std::size_t x, std::size_t y) {
  const std::string text = read_text(file.string());
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::string_view rest = text;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  std::vector<std::pair<double, double>> points;
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (trimmed(line).empty() || trimmed(line).starts_with('#')) continue;
    const std::optional<double> x_found = number(field(line, x)), y_found = number(field(line, y));
    if (points.empty() && !x_found && !y_found) continue;
    const auto fail = [&](const std::string& what) {
      throw InputError(fmt::format("{}: line {}: {}", file.string(), line_number, what));
    };
    for (const auto& [column, found] : {std::pair(x, x_found), std::pair(y, y_found)}) {
      if (found) continue;
      const std::optional<std::string_view> held = field(line, column);
      fail(held ? fmt::format("column {} holds '{}', expected a number", column, printable(held->substr(0, 40)))
                : fmt::format("there is no column {}; columns are counted from 0", column));
    }
    if (!points.empty() && !(*x_found > points.back().first))
      fail(fmt::format("column {} holds {}, expected more than {}, the x before it", x, *x_found, points.back().first));
    points.emplace_back(*x_found, *y_found);
  }
  if (points.size() < 2) {
    throw InputError(fmt::format("{}: found {} with numbers in columns {} and {}, expected at least 2 lines",
                                 file.string(), points.empty() ? "no line" : "1 line", x, y));
  }
  return points;
}

}  // namespace poinsot
