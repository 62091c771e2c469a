// The signals as a table: t, then the columns of integrators/signals.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/records/number_table.h"
#include "core/model.h"
#include "integrators/signals.h"

namespace poinsot::records {

class SignalsWriter {
 public:
  SignalsWriter(const std::filesystem::path& file, const Model& model);  // throws InputError

  const std::vector<std::string>& columns() const { return table_.columns(); }
  void write(const Sample& sample);
  study::OutputFile& file() { return table_.file(); }

 private:
  NumberTable table_;
  std::optional<Signals> signals_;  // from the first sample on
};

}  // namespace poinsot::records
