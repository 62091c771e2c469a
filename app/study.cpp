#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress_line.h"
#include "app/signals.h"
#include "app/terminal.h"
#include "bench/cases/computation.h"
#include "bench/cases/distribute.h"
#include "core/counted.h"
#include "core/input_error.h"

namespace poinsot::app {
using namespace study;
using namespace cases;
namespace {
namespace fs = std::filesystem;

struct StudyOptions {
  std::string file, out = "results", shard, cache = user_cache().string();
  std::vector<std::string> merge;
  std::optional<int> threads;
  bool quick = false, fresh = false, quiet = false;
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

// What the rows come to: the table, the pictures, the record.
int conclude(const StudyOptions& options, const Computation& c) {
  std::vector<fs::path> written;
  const std::string by = caught_signal() != 0 ? signal_text() : "incomplete", why = c.conclude(written, by);
  if (!c.complete()) {
    print_error(c.unfinished(by));
    return caught_signal() != 0 ? signal_status() : kNumericsFailed;
  }
  if (!why.empty()) print_error(why);
  const int status = why.empty() ? kDone : kNumericsFailed;
  if (options.quiet) return status;
  if (const std::int64_t unused = c.table().unused(); unused > 0)
    print_notice(fmt::format("{} in {} of cases that the study does not have", counted(unused, "row is", "rows are"),
                             options.out));
  if (const std::int64_t damaged = c.table().damaged(); damaged > 0)
    print_notice(counted(damaged, "damaged line was", "damaged lines were") + " left out");
  fmt::print("{}, {} failed\n", counted(c.there(), "case"), c.failures());
  for (const fs::path& file : written) fmt::print("{}\n", file.string());
  return status;
}

// Rank 0, or the only process.
int lead_study(const StudyOptions& options, Ranks* ranks) {
  std::optional<Computation> c;
  try {
    if (!options.shard.empty() && !options.merge.empty()) throw InputError("--shard, --merge: expected one of the two");
    c.emplace(read_study(options.file),
              ComputationOptions{options.out, shard_of(options.shard), options.merge, options.threads.value_or(0),
                                 options.quick, options.fresh, options.cache},
              ranks);
  } catch (...) {
    std::string none;
    if (ranks) share(*ranks, none);
    throw;
  }
  if (!options.quiet) std::ranges::for_each(c->study().notices, print_notice);
  if (ranks) {
    std::string content = c->study().content;
    share(*ranks, content);
  }
  if (!options.merge.empty()) return conclude(options, *c);
  const Deferred deferred;
  {
    ProgressLine progress("cases", !options.quiet);
    c->compute([&](const ComputationProgress& here) {
      progress.at({here.done, here.all, here.before},
                  fmt::format(", {:.3g} cases/s, {} failed", here.per_second, here.failed));
    });
  }
  return conclude(options, *c);
}

int follow_study(const StudyOptions& options, Ranks& ranks) {
  std::string content;
  share(ranks, content);
  if (content.empty() || !options.merge.empty()) return kDone;  // rank 0 says why
  const Study study = parse_content(content);
  References references{Cache(options.cache)};
  const Deferred deferred;
  return follow(ranks, study, references, options.threads.value_or(1)) ? kDone : signal_status();
}

int study(const StudyOptions& options) {
  if (options.threads) require_positive("--threads", *options.threads);
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
  const auto [command, options] =
      add_command(app, status, "study", "compute the many cases of a study file into one table", study);
  command.add_option("study", options.file, "study file, JSON (models/study.schema.json)")
      ->required()
      ->type_name("STUDY");
  add_out_folder(command, options.out, "cases.csv and what goes with it");
  command.add_option("--threads", options.threads, "that compute (default: one for each processor)")->type_name("N");
  command.add_option("--shard", options.shard, "compute the I-th of N parts only, into shard-I-of-N.part")
      ->type_name("I/N");
  command
      .add_option("--merge", options.merge,
                  "compute nothing, but put together the parts of all shards; may come several times")
      ->type_name("PART|DIR")
      ->allow_extra_args(false);
  command.add_flag("--quick", options.quick, "a tenth of the cases");
  command.add_flag("--fresh", options.fresh, "compute everything, also what the folder holds already");
  add_cache(command, options.cache);
  add_quiet(command, options.quiet);
  command.footer(
      "A study that was interrupted or killed goes on where it stopped when the command is given again. Started by\n"
      "mpirun or srun, all processes compute its cases and the first one writes them.");
}

}  // namespace poinsot::app
