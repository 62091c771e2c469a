#include "bench/cases/computation.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/cases/distribute.h"
#include "bench/cases/draw.h"
#include "bench/cases/merge.h"
#include "bench/records/run_record.h"
#include "bench/study/measure.h"
#include "bench/study/output_file.h"
#include "bench/study/report.h"
#include "core/input_error.h"

namespace poinsot::cases {
namespace fs = std::filesystem;
namespace {

// Times are those of one run at a time.
void require_alone(const Study& study, const ComputationOptions& options, bool with_ranks) {
  constexpr std::string_view kWhy = "the study measures time, so its cases run one at a time on one core";
  if (!study.timed()) return;
  if (options.threads > 1) throw InputError(fmt::format("--threads: found {}, expected 1: {}", options.threads, kWhy));
  if (options.shard.places > 1) throw InputError(fmt::format("--shard: expected none: {}", kWhy));
  if (with_ranks) throw InputError(fmt::format("found several processes, expected one: {}", kWhy));
}

}  // namespace

std::string Shard::name() const {
  return places == 1 ? "cases" : fmt::format("shard-{}-of-{}", place, places);
}

Computation::Computation(Study study, ComputationOptions options, Ranks* ranks)
    : options_(std::move(options)),
      study_(std::move(study)),
      selection_(study_, options_.quick, options_.shard.place, options_.shard.places),
      table_(study_),
      ranks_(ranks) {
  require_alone(study_, options_, ranks != nullptr);
  if (!options_.merge.empty()) {
    merge(parts_in(options_.merge), selection_, table_);
    study::make_folder(options_.folder);
    return;
  }
  threads_ = options_.threads > 0 ? options_.threads : study_.timed() || ranks ? 1 : processors();
  study::make_folder(options_.folder);
  const fs::path part = options_.folder / (options_.shard.name() + ".part");
  if (options_.fresh) fs::remove(part);
  table_.open(part);
  table_.read(part, false);
}

std::int64_t Computation::there() const {
  std::int64_t count = 0;
  for (std::int64_t k = 0; k < selection_.size(); ++k) count += table_.has(selection_.at(k));
  return count;
}

void Computation::compute(const std::function<void(const ComputationProgress&)>& told) {
  if (!options_.merge.empty() || complete()) return;
  write_record(State::running);
  try {
    compute_rest(told);
  } catch (const study::OutputError& full) {
    try {
      write_record(State::ended, full.what());
    } catch (const study::OutputError&) {  // that of the start stands
    }
    throw;
  }
}

void Computation::compute_rest(const std::function<void(const ComputationProgress&)>& told) {
  using Clock = std::chrono::steady_clock;
  References references{study::Cache(options_.cache)};
  Undone undone(selection_, table_);
  const auto before = static_cast<double>(there()), all = static_cast<double>(selection_.size());
  std::atomic<std::int64_t> done = 0, failed = failures();
  const Clock::time_point began = Clock::now();
  const auto put = [&](CaseRow&& row) {
    table_.add(row);
    ++done;
    failed += row.failed;
  };
  const auto tell = [&] {
    if (!told) return;
    const double passed = std::chrono::duration<double>(Clock::now() - began).count();
    const auto now = static_cast<double>(done);
    told({before + now, all, before, now / passed, failed});
  };
  // Those of one scene together: it is read once for all of them.
  const std::size_t together = std::clamp<std::size_t>(study_.settings.size(), 1, 16);
  const auto take = [&] { return undone.take(together); };
  if (study_.timed()) {
    core_ = study::pin_to_one_core();
    run_timed(study_, references, {take, put, tell});
  } else if (ranks_) {
    lead(*ranks_, study_, references, threads_, undone, put, tell);
  } else {
    run_threads(study_, references, threads_, {take, put, tell});
  }
}

// Where the rows came from, beside them.
void Computation::write_record(State state, const std::string& why) const {
  const std::int64_t rows = there();
  nlohmann::ordered_json json;
  json["status"] = complete() ? "ok" : state == State::running ? "running" : "interrupted";
  json["incomplete"] = !complete();
  if (!why.empty()) json["message"] = why;
  json["cases"] = {{"study", study_.size()}, {"selected", selected()}, {"computed", rows}, {"failed", failures()}};
  json["quick"] = options_.quick;
  if (options_.shard.places > 1) json["shard"] = fmt::format("{}/{}", options_.shard.place, options_.shard.places);
  if (!options_.merge.empty()) json["merged"] = options_.merge;
  json["notices"] = study_.notices;
  if (study_.timed())
    json["timing"] = {{"repetitions", study_.repetitions}, {"one_at_a_time", true}, {"core", core_}};
  else
    json["executors"] = {{"processes", ranks_ ? ranks_->size() : 1}, {"threads", threads_}};
  records::add_origin(json);
  json["content"] = nlohmann::ordered_json::parse(study_.content);
  study::OutputFile file(options_.folder / (options_.shard.name() + ".run.json"));
  file.write(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  file.commit();
}

std::string Computation::unfinished(const std::string& ended_by) const {
  return fmt::format("{}: {} of {} cases are there; the same command goes on with them", ended_by, there(), selected());
}

std::string Computation::conclude(std::vector<fs::path>& written, const std::string& ended_by) const {
  write_record(State::ended, complete() || ended_by.empty() ? "" : unfinished(ended_by));
  if (!complete()) return "";
  if (options_.shard.places > 1) {
    written = {options_.folder / (options_.shard.name() + ".part")};
    return "";
  }
  written = {options_.folder / "cases.csv"};
  table_.write(selection_, written.front());
  return draw_pictures(study_, selection_, table_, options_.folder, study::origin_lines(core_), written);
}

}  // namespace poinsot::cases
