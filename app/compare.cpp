#include "bench/report/compare.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "app/terminal.h"
#include "core/printable.h"

namespace poinsot::app {
using namespace report;
namespace {
using Json = nlohmann::ordered_json;

struct CompareOptions {
  std::string a, b;
  bool json = false, quiet = false;
};

Json as_json(const Comparison& c) {
  Json json{
      {"same", c.same()}, {"times_compared", c.times}, {"common_ratio", c.common}, {"expected_by_chance", c.by_chance}};
  json["changed_times"] = Json::array();
  for (const TimeChange& t : c.changed_times)
    json["changed_times"].push_back({{"file", t.file},
                                     {"cell", t.cell},
                                     {"before", t.before},
                                     {"after", t.after},
                                     {"ratio", t.ratio.median},
                                     {"from", t.ratio.low},
                                     {"to", t.ratio.high},
                                     {"confidence", t.ratio.confidence}});
  json["changed"] = Json::array();
  for (const OtherChange& o : c.changed)
    json["changed"].push_back(
        {{"file", o.file}, {"cell", o.cell}, {"quantity", o.quantity}, {"before", o.before}, {"after", o.after}});
  json["only_a"] = c.only_a;
  json["only_b"] = c.only_b;
  json["not_compared"] = c.not_compared;
  json["origins"] = Json::array();
  for (const auto& o : c.origins) json["origins"].push_back({{"key", o.key}, {"a", o.a}, {"b", o.b}});
  return json;
}

void print_list(const std::string& title, const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  fmt::print("{}\n", title);
  for (const std::string& line : lines) fmt::print("  {}\n", printable(line));
}

void print_text(const CompareOptions& options, const Comparison& c) {
  for (const auto& o : c.origins) fmt::print("{}\n  A: {}\n  B: {}\n", o.key, printable(o.a), printable(o.b));
  fmt::print("times: {} compared, {} changed beyond the noise", c.times, c.changed_times.size());
  if (c.by_chance > 0) fmt::print(" (by chance {:.1f} would)", c.by_chance);
  if (c.times > 0) fmt::print("; all cells together: B takes {:.3f} times as long as A", c.common);
  fmt::print("\n");
  std::vector<std::string> lines;
  for (const TimeChange& t : c.changed_times)
    lines.push_back(
        fmt::format("{}: {}: {:.4g} to {:.4g} {}, {:.3f} ({:.3f} to {:.3f}{})", t.file, t.cell, t.before, t.after,
                    t.ratio.confidence > 0 ? "us" : "s", t.ratio.median, t.ratio.low, t.ratio.high,
                    t.ratio.confidence > 0 ? fmt::format(", {:.1f} %", 100 * t.ratio.confidence) : ", by the spreads"));
  print_list("changed times, from A to B, and their quotient", lines);
  lines.clear();
  for (const OtherChange& o : c.changed)
    lines.push_back(fmt::format("{}: {}{}{}: {}{}{}", o.file, o.cell, o.cell.empty() ? "" : ": ", o.quantity, o.before,
                                o.before.empty() ? "" : " to ", o.after));
  print_list("changed, other than times", lines);
  print_list(fmt::format("only in {}", options.a), c.only_a);
  print_list(fmt::format("only in {}", options.b), c.only_b);
  print_list("not compared", c.not_compared);
  if (c.same()) fmt::print("nothing else differs\n");
}

int compare_folders(const CompareOptions& options) {
  const Results a = read_results(options.a), b = read_results(options.b);
  const Comparison result = compare(a, b);
  if (options.json)
    print_json(stdout, as_json(result));
  else if (!options.quiet)
    print_text(options, result);
  return kDone;
}

}  // namespace

void add_compare(CLI::App& app, int& status) {
  const auto [command, options] =
      add_command(app, status, "compare", "tell what changed between two folders of results", compare_folders);
  command.add_option("A", options.a, "the results before")->required()->type_name("DIR");
  command.add_option("B", options.b, "the results after")->required()->type_name("DIR");
  add_json(command, options.json);
  add_quiet(command, options.quiet);
  command.footer(
      "Times have changed where the interval of the quotients of their repetitions does not hold 1; they are compared\n"
      "of one processor, compiler and flags only. The exit status is 0 whatever changed.");
}

}  // namespace poinsot::app
