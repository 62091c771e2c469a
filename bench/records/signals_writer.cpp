#include "bench/records/signals_writer.h"

namespace poinsot::records {
namespace {

std::vector<std::string> names_of(const Model& model) {
  std::vector<std::string> names = Signals::names(model);
  names.insert(names.begin(), "t");
  return names;
}

}  // namespace

SignalsWriter::SignalsWriter(const std::filesystem::path& file, const Model& model) : table_(file, names_of(model)) {}

void SignalsWriter::write(const Sample& sample) {
  if (!signals_) signals_.emplace(sample.problem);
  signals_->update(sample);
  table_.write(sample.t);
  for (const double value : signals_->values()) table_.write(value);
}

}  // namespace poinsot::records
