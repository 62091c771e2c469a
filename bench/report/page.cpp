#include "bench/report/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "bench/report/assets.h"
#include "bench/report/contents.h"
#include "bench/report/figures.h"
#include "bench/report/findings.h"
#include "bench/report/html.h"
#include "bench/report/origin.h"
#include "core/counted.h"

namespace poinsot::report {
using namespace study;
namespace {

constexpr std::size_t kLong = 12;  // rows of a table that is folded

std::string table_block(std::string_view caption, const std::string& file, const std::vector<std::string>& header,
                        const std::vector<std::vector<std::string>>& rows, const std::string& settings) {
  std::string html = table_html(caption, header, rows);
  if (rows.size() > kLong)
    html = fmt::format("<details><summary>{} (table)</summary>\n{}</details>\n", escape(caption), html);
  return fmt::format("{}<p class=\"source\">{}{}</p>\n", html, link(file, file),
                     settings.empty() ? "" : fmt::format(" · {}", escape(settings)));
}

// Those that are not what is told of all under "Origin".
std::string own_settings(const Results& results, const CsvTable& table) {
  const CsvTable* raw = results.find("raw");
  const std::string settings = table.note("settings");
  return raw && raw->note("settings") == settings ? "" : settings;
}

std::string missing_block(const Results& results, std::string_view what, std::string_view by) {
  return fmt::format("<p class=\"missing\">Missing: {}. <code>poinsot {} --out {}</code> makes it.</p>\n", escape(what),
                     by, escape(results.folder.string()));
}

// "kinematics_phases" says which of several tables of an item it is.
std::string caption_of(const Item& item, const std::string& file) {
  const bool several = !item.tables[1].empty() || !item.figure.empty();
  return several ? fmt::format("{}: {}", item.title, file) : std::string(item.title);
}

std::string item_block(const Results& results, const Item& item, std::set<std::string>& used) {
  std::string html = fmt::format(
      "<h3>{}</h3>\n",
      escape(item.number.empty() ? std::string(item.title) : fmt::format("{}: {}", item.number, item.title)));
  if (!item.text.empty()) html += fmt::format("<p>{}</p>\n", escape(item.text));
  std::vector<std::string> missing;
  if (!item.figure.empty()) {
    const std::string file(item.figure);
    used.insert(file);
    if (const CsvTable* points = results.find(file))
      html += panels_html(*points, std::string(item.title)) +
              fmt::format("<p class=\"source\">{}</p>\n", link(file + ".csv", file + ".csv"));
    else
      missing.push_back(file + ".csv");
  }
  for (const std::string_view name : item.tables) {
    if (name.empty()) continue;
    const std::string file(name);
    used.insert(file);
    if (const CsvTable* table = results.find(file))
      html +=
          table_block(caption_of(item, file), file + ".csv", table->header, table->rows, own_settings(results, *table));
    else
      missing.push_back(file + ".csv");
  }
  if (!missing.empty()) html += missing_block(results, fmt::format("{}", fmt::join(missing, ", ")), item.command);
  return html;
}

std::string charts_block(const Results& results, std::set<std::string>& used) {
  std::string html;
  for (const CsvTable* chart : results.charts()) {
    used.insert(chart->file);
    const std::string scene = chart->note("scene"), title = scene.substr(0, scene.rfind(", content"));
    html += fmt::format("<h3>{}</h3>\n", escape(title.empty() ? chart->file : title));
    html += chart_html(*chart);
    html += table_block(fmt::format("{}: every case", chart->file), chart->file + ".csv", chart->header, chart->rows,
                        chart->note("settings"));
  }
  return html.empty() ? missing_block(results, "work-precision charts", "chart --all --quick") : html;
}

std::string studies_block(const Results& results, std::set<std::string>& used) {
  std::string html;
  for (const StudyResults& study : results.studies) {
    html += fmt::format("<h3>{}</h3>\n<p>{}{}{}{}</p>\n", escape(study.name), escape(study.about),
                        study.quick ? " Here a tenth of its cases (--quick)." : "",
                        study.incomplete ? " The study is incomplete." : "",
                        study.failed > 0 ? fmt::format(" Of {} {} failed: numbers and pictures are of the others.",
                                                       counted(study.cases, "case"), study.failed)
                                         : "");
    for (const StudyPicture& picture : study.pictures) {
      const std::string file = study.folder + picture.file;
      for (const char* suffix : {"", "_table"}) used.insert(file + suffix);
      html += fmt::format("<h4>{}</h4>\n", escape(picture.title)) + panels_html(picture.points, picture.title) +
              fmt::format("<p class=\"source\">{}</p>\n", link(file + ".csv", file + ".csv")) +
              table_block(picture.title, file + "_table.csv", picture.numbers.header, picture.numbers.rows, "");
    }
    used.insert(study.folder + "cases");
    html += fmt::format("<p class=\"source\">Every case: {}</p>\n",
                        link(study.folder + "cases.csv", study.folder + "cases.csv"));
  }
  return html.empty() ? fmt::format(
                            "<p class=\"missing\">Missing: studies. <code>poinsot study FILE --out {}/NAME</code> "
                            "makes one.</p>\n",
                            escape(results.folder.string()))
                      : html;
}

std::string findings_block(const Findings& found) {
  std::string html;
  for (const Finding& finding : found.all) {
    html += fmt::format("<section class=\"finding\" aria-labelledby=\"{}\"><h3 id=\"{}\">{}</h3>\n<ul>\n", finding.id,
                        finding.id, escape(finding.title));
    for (const std::string& sentence : finding.sentences) html += fmt::format("<li>{}</li>\n", escape(sentence));
    html += "</ul></section>\n";
  }
  for (const std::string& what : found.missing)
    html += fmt::format("<p class=\"missing\">Missing: {}</p>\n", escape(what));
  for (const Table& table : found.tables)
    html += (table.text.empty() ? "" : fmt::format("<p>{}</p>\n", escape(table.text))) +
            table_block(table.title, table.file + ".csv", table.header, table.rows, "");
  return html;
}

std::string others_block(const Results& results, const std::set<std::string>& used) {
  std::string html;
  for (const auto& [name, table] : results.tables)
    if (!used.contains(name)) html += fmt::format("<li>{}</li>\n", link(name + ".csv", name + ".csv"));
  return html.empty() ? "" : fmt::format("<h3>Further tables in the folder</h3>\n<ul>{}</ul>\n", html);
}

std::string section(std::string_view id, std::string_view title, const std::string& body) {
  return fmt::format("<section aria-labelledby=\"s-{}\">\n<h2 id=\"s-{}\">{}</h2>\n{}</section>\n", id, id,
                     escape(title), body);
}

Table contents_table() {
  Table table{"report_contents",
              "What the page shows",
              "",
              {"section", "number in the paper", "title", "figure", "tables", "command"}};
  for (const Section& s : contents())
    for (const Item& item : s.items) {
      std::vector<std::string_view> files;
      for (const auto file : item.tables)
        if (!file.empty()) files.push_back(file);
      table.rows.push_back({std::string(s.title), std::string(item.number), std::string(item.title),
                            std::string(item.figure), fmt::format("{}", fmt::join(files, " ")),
                            fmt::format("poinsot {}", item.command)});
    }
  return table;
}

}  // namespace

Page page(const Results& results) {
  const Findings found = findings(results);
  std::set<std::string> used{"raw"};
  std::string nav = "<li><a href=\"#s-findings\">Findings</a></li>", body;
  body += section("findings", "Findings", reservations_block(results) + findings_block(found));
  for (const Section& s : contents()) {
    std::string own;
    for (const Item& item : s.items) own += item_block(results, item, used);
    if (s.id == "precision") own += charts_block(results, used);
    nav += fmt::format("<li><a href=\"#s-{}\">{}</a></li>", s.id, escape(s.title));
    body += section(s.id, s.title, own);
  }
  nav += "<li><a href=\"#s-studies\">Studies</a></li><li><a href=\"#s-origin\">Origin</a></li>";
  body += section("studies", "Studies", studies_block(results, used));
  std::string origin = origin_block(results);
  if (results.find("raw"))
    origin += fmt::format("<p class=\"source\">Every repetition: {}</p>\n", link("raw.csv", "raw.csv"));
  body += section("origin", "Origin", origin + others_block(results, used));

  Page page;
  page.html = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
      "style-src "
      "'unsafe-inline'; img-src data:\">\n<link rel=\"icon\" href=\"data:,\">\n<title>Poinsot: report</title>\n"
      "<style>{}</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#main\">To the findings</a>\n"
      "<header><h1>Rotation in constrained multibody dynamics: three formulations measured</h1>\n<p>{}</p></header>\n"
      "<nav aria-label=\"Sections\"><ul>{}</ul></nav>\n<main id=\"main\" "
      "tabindex=\"-1\">\n{}</main>\n<script>{}</script>\n"
      "</body>\n</html>\n",
      kStyle,
      "Mechanisms are solved in absolute coordinates with the orientation matrix itself (rA), with Euler parameters "
      "(rp) "
      "and with Euler angles (reps). Sentences and pictures here are computed from tables in the same folder; each "
      "names "
      "its file. A column's heading sorts its table.",
      nav, body, kScript);
  page.tables = found.tables;
  page.tables.push_back(contents_table());
  if (!results.studies.empty()) page.tables.push_back(studies_table(results.studies));
  for (const auto& [key, value] : origins(results)) page.foot.push_back(fmt::format("{}: {}", key, value));
  return page;
}

}  // namespace poinsot::report
