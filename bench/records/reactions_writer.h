// The reactions as CSV: t, then for each constraint its multiplier, and for each joint and driver the force and moment
// on body j at its point, global, N and N m.
#pragma once

#include <optional>

#include "bench/study/output_file.h"
#include "core/model.h"
#include "integrators/start/reactions.h"

namespace poinsot::records {

class ReactionsWriter {
 public:
  ReactionsWriter(const std::filesystem::path& file, const Model& model);  // throws InputError

  std::size_t columns() const { return columns_; }
  void write(const Sample& sample);
  study::OutputFile& file() { return file_; }

 private:
  study::OutputFile file_;
  std::size_t columns_ = 1;
  std::optional<Reactions> reactions_;  // from the first sample on
};

}  // namespace poinsot::records
