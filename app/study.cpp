#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/run_record.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "bench/cases/distribute.h"
#include "bench/cases/draw.h"
#include "bench/cases/merge.h"
#include "bench/study/measure.h"
#include "bench/study/output_file.h"
#include "bench/study/report.h"
#include "core/input_error.h"
#include "core/interruption.h"

namespace poinsot::app {
using namespace study;
using namespace cases;
namespace {
namespace fs = std::filesystem;

struct Options {
  std::string file, out = "results", shard, cache = user_cache().string();
  std::vector<std::string> merge;
  int threads = 0;
  bool quick = false, fresh = false, quiet = false;
};

struct Shard {
  int place = 1, places = 1;

  std::string name() const { return places == 1 ? "cases" : fmt::format("shard-{}-of-{}", place, places); }
};

Shard shard_of(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  const char* const end = text.data() + text.size();
  const auto [slash, wrong] = std::from_chars(text.data(), end, shard.place);
  const bool half = wrong == std::errc() && slash != end && *slash == '/';
  const auto rest = half ? std::from_chars(slash + 1, end, shard.places) : std::from_chars_result{};
  constexpr int kMost = 1'000'000;
  if (!half || rest.ec != std::errc() || rest.ptr != end || shard.place < 1 || shard.place > shard.places ||
      shard.places > kMost)
    throw InputError(fmt::format("--shard: found \"{}\", expected I/N, the I-th of N from 1 on", text));
  return shard;
}

// Times are those of one run at a time.
void require_alone(const Study& study, const Options& options, bool with_ranks) {
  constexpr std::string_view kWhy = "the study measures time, so its cases run one at a time on one core";
  if (!study.timed()) return;
  if (options.threads > 1) throw InputError(fmt::format("--threads: found {}, expected 1: {}", options.threads, kWhy));
  if (!options.shard.empty()) throw InputError(fmt::format("--shard: expected none: {}", kWhy));
  if (with_ranks) throw InputError(fmt::format("found several processes, expected one: {}", kWhy));
}

// All that a study needs of this process.
struct Computation {
  Computation(const Options& options, Study&& read, bool with_ranks)
      : study(std::move(read)),
        shard(shard_of(options.shard)),
        selection(study, options.quick, shard.place, shard.places),
        table(study),
        folder(options.out) {
    require_alone(study, options, with_ranks);
    if (!options.merge.empty()) {
      if (!options.shard.empty()) throw InputError("--shard, --merge: expected one of the two");
      merge(parts_in(options.merge), selection, table);
      make_folder(folder);
      return;
    }
    threads = options.threads > 0 ? options.threads : study.timed() || with_ranks ? 1 : processors();
    make_folder(folder);
    const fs::path part = folder / (shard.name() + ".part");
    if (options.fresh) fs::remove(part);
    table.open(part);
    table.read(part, false);
  }
  std::int64_t there() const {
    std::int64_t count = 0;
    for (std::int64_t k = 0; k < selection.size(); ++k) count += table.has(selection.at(k));
    return count;
  }

  Study study;
  Shard shard;
  Selection selection;
  CaseTable table;
  fs::path folder;
  int threads = 1, ranks = 1, core = -1;
};

// Where the rows came from, beside them.
void write_record(const Options& options, const Computation& c, std::int64_t there) {
  nlohmann::ordered_json json;
  json["status"] = there == c.selection.size() ? "ok" : "interrupted";
  json["incomplete"] = there < c.selection.size();
  json["cases"] = {
      {"study", c.study.size()}, {"selected", c.selection.size()}, {"computed", there}, {"failed", c.table.failures()}};
  json["quick"] = options.quick;
  if (!options.shard.empty()) json["shard"] = options.shard;
  if (!options.merge.empty()) json["merged"] = options.merge;
  json["notices"] = c.study.notices;
  if (c.study.timed())
    json["timing"] = {{"repetitions", c.study.repetitions}, {"one_at_a_time", true}, {"core", c.core}};
  else
    json["executors"] = {{"processes", c.ranks}, {"threads", c.threads}};
  add_origin(json);
  json["content"] = nlohmann::ordered_json::parse(c.study.content);
  OutputFile file(c.folder / (c.shard.name() + ".run.json"));
  file.write(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  file.commit();
}

void compute(const Options& options, Computation& c, Ranks* ranks) {
  using Clock = std::chrono::steady_clock;
  References references{Cache(options.cache)};
  Undone undone(c.selection, c.table);
  const auto before = static_cast<double>(c.there()), all = static_cast<double>(c.selection.size());
  std::atomic<std::int64_t> done = 0;
  const Clock::time_point began = Clock::now();
  ProgressLine progress("cases", !options.quiet);
  const auto put = [&](CaseRow&& row) {
    c.table.add(row);
    ++done;
  };
  const auto tell = [&] {
    const double passed = std::chrono::duration<double>(Clock::now() - began).count();
    progress.at({before + static_cast<double>(done), all, before},
                fmt::format(", {:.3g} cases/s, {} failed", static_cast<double>(done) / passed, c.table.failures()));
  };
  // Those of one scene together: it is read once for all of them.
  const std::size_t together = std::clamp<std::size_t>(c.study.settings.size(), 1, 16);
  const auto take = [&] { return undone.take(together); };
  if (c.study.timed()) {
    c.core = pin_to_one_core();
    run_timed(c.study, references, {take, put, tell});
  } else if (ranks) {
    lead(*ranks, c.study, references, c.threads, undone, put, tell);
  } else {
    run_threads(c.study, references, c.threads, {take, put, tell});
  }
}

// What the rows come to: the table, the pictures, the record.
int conclude(const Options& options, const Computation& c) {
  const std::int64_t there = c.there();
  write_record(options, c, there);
  if (there < c.selection.size()) {
    print_error(fmt::format("{}: {} of {} cases are there; the same command goes on with them", signal_text(), there,
                            c.selection.size()));
    return caught_signal() != 0 ? signal_status() : kNumericsFailed;
  }
  int status = kDone;
  std::vector<fs::path> written{c.folder / (c.shard.name() + ".part")};
  if (c.shard.places == 1) {
    written = {c.folder / "cases.csv"};
    c.table.write(c.selection, written.front());
    const std::string why = draw_pictures(c.study, c.selection, c.table, c.folder, origin_lines(c.core), written);
    if (!why.empty()) {
      print_error(why);
      status = kNumericsFailed;
    }
  }
  if (options.quiet) return status;
  if (c.table.unused() > 0)
    print_notice(
        fmt::format("{} rows in {} are of cases that the study does not have", c.table.unused(), c.folder.string()));
  if (c.table.damaged() > 0) print_notice(fmt::format("{} damaged lines were left out", c.table.damaged()));
  fmt::print("{} cases, {} failed\n", there, c.table.failures());
  for (const fs::path& file : written) fmt::print("{}\n", file.string());
  return status;
}

// Rank 0, or the only process.
int lead_study(const Options& options, Ranks* ranks) {
  std::optional<Computation> c;
  try {
    c.emplace(options, read_study(options.file), ranks != nullptr);
  } catch (...) {
    std::string none;
    if (ranks) share(*ranks, none);
    throw;
  }
  if (!options.quiet) std::ranges::for_each(c->study.notices, print_notice);
  if (ranks) {
    c->ranks = ranks->size();
    share(*ranks, c->study.content);
  }
  if (!options.merge.empty()) return conclude(options, *c);
  const Deferred deferred;
  compute(options, *c, ranks);
  return conclude(options, *c);
}

int follow_study(const Options& options, Ranks& ranks) {
  std::string content;
  share(ranks, content);
  if (content.empty() || !options.merge.empty()) return kDone;  // rank 0 says why
  const Study study = parse_content(content);
  References references{Cache(options.cache)};
  const Deferred deferred;
  return follow(ranks, study, references, std::max(1, options.threads)) ? kDone : signal_status();
}

int study(const Options& options) {
  if (options.threads < 0) require_positive("--threads", options.threads);
  if (!started_by_launcher()) return lead_study(options, nullptr);
  const std::unique_ptr<Ranks> ranks = join_ranks();
  try {
    const int status = ranks->rank() > 0   ? follow_study(options, *ranks)
                       : ranks->size() > 1 ? lead_study(options, ranks.get())
                                           : lead_study(options, nullptr);
    ranks->finish();
    return status;
  } catch (const std::exception& error) {  // the others wait for this one
    print_error(error.what());
    const bool input = dynamic_cast<const InputError*>(&error) != nullptr;
    ranks->abort(input ? kWrongInput : kNumericsFailed);
    return kNumericsFailed;
  }
}

}  // namespace

void add_study(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("study", "compute the many cases of a study file into one table");
  const auto options = std::make_shared<Options>();
  command->add_option("study", options->file, "study file, JSON (models/study.schema.json)")
      ->required()
      ->type_name("STUDY");
  add_out_folder(*command, options->out, "cases.csv and what goes with it");
  command->add_option("--threads", options->threads, "that compute (default: one for each processor)")->type_name("N");
  command->add_option("--shard", options->shard, "compute the I-th of N parts only, into shard-I-of-N.part")
      ->type_name("I/N");
  command
      ->add_option("--merge", options->merge,
                   "compute nothing, but put together the parts of all shards; may come several times")
      ->type_name("PART|DIR")
      ->allow_extra_args(false);
  command->add_flag("--quick", options->quick, "a tenth of the cases");
  command->add_flag("--fresh", options->fresh, "compute everything, also what the folder holds already");
  add_cache(*command, options->cache);
  add_quiet(*command, options->quiet);
  command->footer(
      "A study that was interrupted or killed goes on where it stopped when the command is given again. Started by\n"
      "mpirun or srun, all processes compute its cases and the first one writes them.");
  command->callback([options, &status] { status = study(*options); });
}

}  // namespace poinsot::app
