// One case, computed: what the study keeps of it, as the fields of its row.
//
// What does not change from case to case is kept: the scene where only settings differ, its reference. A case whose
// input is wrong, or whose numerics fail, is a row with its status and message.
#pragma once

#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bench/cases/case_table.h"
#include "bench/study/reference.h"
#include "core/varied_scene.h"

namespace poinsot::cases {

// Of all threads: references are computed once.
class References {
 public:
  explicit References(study::Cache cache) : cache_(std::move(cache)) {}
  std::shared_ptr<const study::Reference> find(const Scene& scene, const study::ReferenceSettings& settings);

 private:
  using Known = std::pair<std::string, std::shared_future<std::shared_ptr<const study::Reference>>>;  // by key

  static constexpr std::size_t kMost = 64;  // kept in memory
  study::Cache cache_;
  std::mutex access_;
  std::vector<Known> known_;  // the latest last
};

struct Result {
  std::string status = "ok", message;
  std::vector<double> values;  // by Kept::columns(); none after a failure

  bool ok() const { return status == "ok"; }
};

// For one thread.
class CaseRunner {
 public:
  CaseRunner(const Study& study, References& references);

  // Nothing where it was interrupted.
  std::optional<CaseRow> run(std::int64_t number);
  // Cases of one scene and the same parameters that are timed in turn (bench/study/measure.h).
  std::vector<CaseRow> run_timed(const std::vector<std::int64_t>& numbers);

 private:
  const Scene& scene_of(const Case& one);
  Result computed(const Case& one);  // but for the times

  const Study& study_;
  References& references_;
  std::vector<std::string> names_;  // of the parameters
  std::size_t columns_;             // kept
  std::optional<VariedScene> text_;
  std::size_t text_of_ = 0;
  Scene varied_;  // the scene of the last case with parameters, of this one and these:
  std::size_t varied_of_ = 0;
  std::vector<double> varied_by_;
};

// Whether two cases differ in their settings alone.
bool same_scene(const Study& study, std::int64_t one, std::int64_t other);

}  // namespace poinsot::cases
