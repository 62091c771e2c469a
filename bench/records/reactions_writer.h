// The reactions as a table: t, then for each constraint its multiplier, and for each joint and driver the force and
// moment on body j at its point, global, N and N m.
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

  const std::vector<std::string>& columns() const { return table_.columns(); }
  void write(const Sample& sample);
  study::OutputFile& file() { return table_.file(); }

 private:
  NumberTable table_;
  std::optional<Reactions> reactions_;  // from the first sample on
};

}  // namespace poinsot::records
