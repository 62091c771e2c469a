// The reactions as a table: t, then for each constraint its multiplier, and for each joint and driver the force and
// moment on body j at its point, global, N and N m.
//
// Where redundant rows leave some of them undetermined, columns behind these say of which: of each joint, driver and
// constraint in a loop with such rows "NAME.fx.undetermined" and so on, 1 where the component is not the only one at
// the sample, others being as right, 0 where it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/records/number_table.h"
#include "core/model.h"
#include "integrators/start/reactions.h"

namespace poinsot::records {

class ReactionsWriter {
 public:
  ReactionsWriter(const std::filesystem::path& file, const Model& model);  // throws InputError

  // Before the first sample, those that every run has.
  const std::vector<std::string>& columns() const { return table_.begun() ? table_.columns() : columns_; }
  void write(const Sample& sample);
  void end();  // of the run, which may have had no sample
  study::OutputFile& file() { return table_.file(); }

 private:
  void begin(const Model& model);
  void write_undetermined(const Model& model);

  NumberTable table_;
  std::vector<std::string> columns_;
  std::optional<Reactions> reactions_;  // from the first sample on
  std::vector<int> undetermined_;       // groups with columns that say so
};

}  // namespace poinsot::records
