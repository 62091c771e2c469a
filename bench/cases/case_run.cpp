#include "bench/cases/case_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "bench/cases/watch.h"
#include "bench/study/csv.h"
#include "bench/study/measure.h"
#include "core/input_error.h"
#include "core/interruption.h"
#include "core/places.h"
#include "core/scene_writer.h"
#include "integrators/simulate.h"

namespace poinsot::cases {
namespace {

std::string fields(const Study& study, const Case& one, const Result& result, std::size_t columns) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  const StudyScene& scene = study.scenes[one.scene];
  fmt::format_to(out, "{},{}", study::csv_field(scene.name), scene.scene.bodies.size());
  for (const double value : one.parameters) fmt::format_to(out, ",{}", value);
  for (const std::string& value : study.settings[one.settings].values) fmt::format_to(out, ",{}", value);
  fmt::format_to(out, ",{}", result.status);
  for (std::size_t k = 0; k < columns; ++k) {
    text.push_back(',');
    if (k < result.values.size() && std::isfinite(result.values[k])) fmt::format_to(out, "{}", result.values[k]);
  }
  std::string message = with_lines(result.message, scene.scene.source);
  std::ranges::replace_if(
      message, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  fmt::format_to(out, ",{}", study::csv_field(message));
  return fmt::to_string(text);
}

}  // namespace

bool same_scene(const Study& study, std::int64_t one, std::int64_t other) {
  const auto settings = static_cast<std::int64_t>(study.settings.size());
  return one / settings == other / settings;
}

std::shared_ptr<const study::Reference> References::find(const Scene& scene, const study::ReferenceSettings& settings) {
  const std::string key = study::reference_key(scene, settings, scene.source.empty() ? to_json(scene) : std::string());
  std::promise<std::shared_ptr<const study::Reference>> promise;
  const auto future = promise.get_future().share();
  {
    std::unique_lock lock(access_);
    if (const auto at = std::ranges::find(known_, key, &Known::first); at != known_.end()) {
      const auto found = at->second;
      lock.unlock();  // it may be under way in another thread
      return found.get();
    }
    if (known_.size() == kMost) known_.erase(known_.begin());
    known_.emplace_back(key, future);
  }
  try {
    std::vector<std::string> notices;
    promise.set_value(std::make_shared<const study::Reference>(study::reference(scene, settings, cache_, notices)));
  } catch (...) {
    promise.set_exception(std::current_exception());
  }
  return future.get();
}

CaseRunner::CaseRunner(const Study& study, References& references)
    : study_(study), references_(references), names_(parameter_names(study)), columns_(study.kept.columns().size()) {}

const Scene& CaseRunner::scene_of(const Case& one) {
  const Scene& scene = study_.scenes[one.scene].scene;
  if (one.parameters.empty()) return scene;
  if (varied_of_ == one.scene && varied_by_ == one.parameters) return varied_;
  if (!text_ || text_of_ != one.scene) {
    text_.emplace(scene);
    text_of_ = one.scene;
  }
  std::map<std::string, double> values;
  for (std::size_t k = 0; k < names_.size(); ++k) values.emplace(names_[k], one.parameters[k]);
  varied_by_.clear();  // until it is read
  varied_ = text_->with(values);
  if (study_.kept.errors) varied_.source = text_->source();  // by which references are known
  varied_of_ = one.scene;
  varied_by_ = one.parameters;
  return varied_;
}

Result CaseRunner::computed(const Case& one) {
  try {
    const Scene& scene = scene_of(one);
    const Settings& settings = study_.settings[one.settings].settings;
    Watch watch(study_.kept, study_.scenes[one.scene].columns);
    const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) { watch.observe(sample); });
    if (!outcome.status.ok()) return {std::string(name(outcome.status.failure)), outcome.status.message, {}};
    Result result;
    if (study_.kept.notices) result.message = fmt::format("{}", fmt::join(outcome.notices, "; "));
    std::shared_ptr<const study::Reference> reference;
    if (study_.kept.errors) {
      reference = references_.find(scene, {settings.end, settings.every, study_.kept.digits});
      if (reference->given < 0) {
        result.message = study::why_none(*reference);
        reference = nullptr;
      }
    }
    result.values = watch.values(outcome.statistics, reference.get());
    return result;
  } catch (const InputError& error) {
    return {"input_error", error.what(), {}};
  }
}

std::optional<CaseRow> CaseRunner::run(std::int64_t number) {
  const Case one = case_of(study_, number);
  const Result result = computed(one);
  if (interruption_requested) return {};  // what it was at may have ended early
  return make_row(study_, one, fields(study_, one, result, columns_), !result.ok());
}

std::vector<CaseRow> CaseRunner::run_timed(const std::vector<std::int64_t>& numbers) {
  std::vector<Case> all;
  std::vector<Result> results;
  std::vector<study::Cell> cells;
  for (const std::int64_t number : numbers) {
    const Case& one = all.emplace_back(case_of(study_, number));
    const Result& result = results.emplace_back(computed(one));
    study::Cell& cell = cells.emplace_back();
    if (result.ok()) {
      cell.scene = &scene_of(one);  // as it was read for that
      cell.settings = study_.settings[one.settings].settings;
    } else {
      cell.failure = result.message.empty() ? result.status : result.message;
    }
  }
  study::measure(cells, {study_.repetitions});
  std::vector<CaseRow> rows;
  if (interruption_requested) return rows;
  for (std::size_t k = 0; k < all.size(); ++k) {
    Result& result = results[k];
    if (result.ok()) {
      const auto of = [&](study::PhaseSeconds phase) {
        std::vector<double> seconds;
        for (const Statistics& run : cells[k].runs) seconds.push_back(phase(run));
        return study::timing(seconds);
      };
      const study::Timing total = of(study::total);
      result.values.insert(result.values.end(),
                           {total.median, total.spread, of(study::assembly).median, of(study::factor).median,
                            of(study::solve).median, of(study::rest).median});
    }
    rows.push_back(make_row(study_, all[k], fields(study_, all[k], result, columns_), !result.ok()));
  }
  return rows;
}

}  // namespace poinsot::cases
