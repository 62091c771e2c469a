#include <fmt/format.h>

#include "app/commands.h"
#include "app/named_files.h"
#include "app/options.h"
#include "app/terminal.h"
#include "bench/report/page.h"
#include "bench/study/output_file.h"

namespace poinsot::app {
using namespace study;
namespace {
namespace fs = std::filesystem;

struct ReportOptions {
  std::string folder, out;
  bool quiet = false;
};

int write_page(const ReportOptions& options) {
  const report::Results results = report::read_results(options.folder);
  const fs::path out = options.out.empty() ? results.folder / "report.html" : fs::path(options.out);
  for (const auto& [name, table] : results.tables)
    refuse_overwriting({{"a table of the folder", (results.folder / (name + ".csv")).string()}},
                       {{"--out", out.string()}});
  const report::Page page = report::page(results);
  OutputFile file(out);
  file.write(page.html);
  file.complete();
  for (const Table& table : page.tables) {
    OutputFile beside(results.folder / (table.file + ".csv"));
    beside.write(csv(table, page.foot));
    beside.commit();
  }
  file.commit();
  if (!options.quiet) fmt::print("{}\n", out.string());
  return kDone;
}

}  // namespace

void add_report(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "report", "write a page that shows a folder of results", write_page);
  command.add_option("FOLDER", options.folder, "that tables, figures, scale and chart have written to")
      ->required()
      ->type_name("DIR");
  command.add_option("--out", options.out, "the page (default FOLDER/report.html)")->type_name("FILE.html");
  add_quiet(command, options.quiet);
  command.footer(
      "What the sentences of the page are made of is written beside the tables, as report_*.csv. What the folder does\n"
      "not hold the page says, and which command makes it.");
}

}  // namespace poinsot::app
