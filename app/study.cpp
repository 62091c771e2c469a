#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/run_record.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "bench/cases/executor.h"
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
  bool quick = false, fresh = false, merging = false, quiet = false;
};

struct Shard {
  int place = 1, places = 1;

  std::string part() const { return places == 1 ? "cases.part" : fmt::format("shard-{}-of-{}.part", place, places); }
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

// Where the rows came from, beside them.
void write_record(const Options& options, const Study& study, const Selection& selection, const CaseTable& table,
                  int threads, int core) {
  nlohmann::ordered_json json;
  std::int64_t there = 0;
  for (std::int64_t k = 0; k < selection.size(); ++k) there += table.has(selection.at(k));
  json["status"] = there == selection.size() ? "ok" : "incomplete";
  json["incomplete"] = there < selection.size();
  json["cases"] = {{"all", study.size()}, {"selected", selection.size()}, {"computed", there}};
  json["quick"] = options.quick;
  json["notices"] = study.notices;
  if (study.timed())
    json["timing"] = {{"repetitions", study.repetitions}, {"core", core}, {"one_at_a_time", true}};
  else
    json["threads"] = threads;
  add_origin(json);
  json["content"] = nlohmann::ordered_json::parse(study.content);
  OutputFile file(fs::path(options.out) / "cases.run.json");
  file.write(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  file.commit();
}

int study(const Options& options) {
  const Shard shard = shard_of(options.shard);
  if (options.threads < 0) require_positive("--threads", options.threads);
  const Study study = read_study(options.file);
  const int threads = options.threads > 0 ? options.threads : study.timed() ? 1 : processors();
  if (!options.quiet) std::ranges::for_each(study.notices, print_notice);
  const Selection selection(study, options.quick, shard.place, shard.places);
  make_folder(options.out);
  CaseTable table(study);
  const fs::path part = fs::path(options.out) / shard.part();
  if (options.fresh) fs::remove(part);
  table.open(part);
  table.read(part, false);
  References references{Cache(options.cache)};
  Undone undone(selection, table);
  {
    Deferred deferred;
    Work work;
    work.take = [&] { return undone.take(1); };
    work.put = [&](CaseRow&& row) { table.add(row); };
    work.meanwhile = [] {};
    run_threads(study, references, threads, work);
  }
  if (shard.places == 1) table.write(selection, fs::path(options.out) / "cases.csv");
  write_record(options, study, selection, table, threads, -1);
  return kDone;
}

}  // namespace

void add_study(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("study", "compute many cases, described by a file, into one table");
  const auto options = std::make_shared<Options>();
  command->add_option("study", options->file, "study file, JSON")->required()->type_name("STUDY");
  add_out_folder(*command, options->out, "cases.csv and what goes with it");
  command->add_option("--threads", options->threads, "that compute (default: as many as there are processors)")
      ->type_name("N");
  command->add_option("--shard", options->shard, "compute the I-th of N parts only")->type_name("I/N");
  command->add_flag("--quick", options->quick, "a tenth of the cases");
  command->add_flag("--fresh", options->fresh, "compute everything, also what the folder holds already");
  add_cache(*command, options->cache);
  add_quiet(*command, options->quiet);
  command->callback([options, &status] { status = study(*options); });
}

}  // namespace poinsot::app
