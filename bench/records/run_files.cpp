#include "bench/records/run_files.h"

#include <fmt/format.h>

#include "core/interruption.h"

namespace poinsot::records {
using namespace study;
namespace {

constexpr std::chrono::milliseconds kBetween{500};

}  // namespace

RunFiles::RunFiles(const Names& names, const Scene& scene, const TrajectoryContent& content,
                   std::function<std::string()> running)
    : record_name_(names.record), running_(std::move(running)), next_(Clock::now() + kBetween) {
  if (!names.trajectory.empty()) trajectory_.emplace(names.trajectory, scene, content);
  if (!names.reactions.empty()) reactions_.emplace(names.reactions, compile(scene));
  if (!names.signals.empty()) signals_.emplace(names.signals, compile(scene));
  if (!names.state.empty()) state_.emplace(names.state, scene);
  if (!record_name_.empty()) record_.emplace(record_name_);
}

ColumnsByOption RunFiles::unnamed_columns() {
  ColumnsByOption columns;
  if (trajectory_ && is_npy(trajectory_->file().target())) columns.emplace_back("--out", trajectory_->columns());
  if (signals_ && is_npy(signals_->file().target())) columns.emplace_back("--signals", signals_->columns());
  return columns;
}

void RunFiles::guarded(OutputFile& file, const std::function<void()>& act) {
  try {
    act();
  } catch (const OutputError& error) {
    interruption_requested = true;
    if (!lost_.empty()) return;
    lost_ = error.what();
    if (!is_device(file.target()))
      lost_ += file.lines() < 2 ? "; nothing of it is kept"
                                : fmt::format("; what is kept of it ends with row {}", file.lines() - 1);
  }
}

void RunFiles::with_files(void (OutputFile::*act)()) {
  const auto with = [&](auto& writer) {
    if (writer) guarded(writer->file(), [&] { (writer->file().*act)(); });
  };
  with(trajectory_);
  with(reactions_);
  with(signals_);
}

void RunFiles::write(const Sample& sample) {
  if (state_) state_->keep(sample);
  if (!any() || !lost_.empty()) return;
  const auto add = [&](auto& writer) {
    if (writer) guarded(writer->file(), [&] { writer->write(sample); });
  };
  add(trajectory_);
  add(reactions_);
  add(signals_);
  if (Clock::now() >= next_) flush();
}

void RunFiles::flush() {
  with_files(&OutputFile::flush);
  if (running_ && record_) {
    try {
      record_->write(running_());
      record_->commit();
    } catch (const OutputError&) {  // the record at the end may find room, and says it otherwise
    }
    record_.reset();
  }
  running_ = {};
  next_ = Clock::now() + kBetween;
}

void RunFiles::complete(bool ended) {
  with_files(&OutputFile::complete);
  if (!state_) return;
  if (!ended || !lost_.empty()) {
    state_.reset();
    return;
  }
  guarded(state_->file(), [&] {
    state_->write();
    state_->file().complete();
  });
}

void RunFiles::commit(const std::string& record) {
  if (!record_name_.empty()) {
    try {
      if (!record_) record_.emplace(record_name_);
      record_->write(record);
      record_->complete();
    } catch (const std::exception& error) {  // what was computed is kept all the same
      if (lost_.empty()) lost_ = error.what();
      record_.reset();
    }
  }
  with_files(&OutputFile::commit);
  if (state_) guarded(state_->file(), [&] { state_->file().commit(); });
  if (record_) record_->commit();
}

}  // namespace poinsot::records
