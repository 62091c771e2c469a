#include "bench/report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "bench/study/csv.h"

namespace poinsot::report {

std::string escape(std::string_view text) {
  static constexpr std::pair<char, std::string_view> kMarkup[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string escaped;
  for (const char c : text) {
    const auto* markup = std::ranges::find(kMarkup, c, &std::pair<char, std::string_view>::first);
    if (markup != std::end(kMarkup))
      escaped += markup->second;
    else
      escaped += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return escaped;
}

std::string link(std::string_view file, std::string_view text) {
  std::string address;
  for (const char c : file) {
    const auto u = static_cast<unsigned char>(c);
    address +=
        std::isalnum(u) || c == '_' || c == '-' || c == '.' || c == '/' ? std::string(1, c) : fmt::format("%{:02X}", u);
  }
  return fmt::format("<a href=\"{}\">{}</a>", address, escape(text));
}

std::string table_html(std::string_view caption, const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows) {
  std::string html = fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{}\"><table><caption>{}</caption><thead><tr>",
      escape(caption), escape(caption));
  for (const std::string& name : header) html += fmt::format("<th scope=\"col\">{}</th>", escape(name));
  html += "</tr></thead>\n<tbody>";
  for (const auto& row : rows) {  // a row and a cell end where the next begin
    html += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k)
      html += fmt::format("<{}>{}",
                          k == 0                                     ? "th scope=\"row\""
                          : std::isfinite(study::csv_number(row[k])) ? "td"
                                                                     : "td class=\"t\"",
                          escape(row[k]));
    html += '\n';
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace poinsot::report
