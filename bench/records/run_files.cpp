#include "bench/records/run_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "core/interruption.h"

namespace poinsot::records {
using namespace study;
namespace {

constexpr std::chrono::milliseconds kBetween{500};
constexpr std::size_t kRecordGrows = 4096;  // bytes, at most, from its first to its last state

}  // namespace

RunFiles::RunFiles(const Names& names, const Scene& scene, const TrajectoryContent& content, RecordText running)
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
  if (reactions_ && is_npy(reactions_->file().target())) columns.emplace_back("--reactions", reactions_->columns());
  if (signals_ && is_npy(signals_->file().target())) columns.emplace_back("--signals", signals_->columns());
  return columns;
}

double RunFiles::longest_row() {
  constexpr std::size_t kInText = 25;  // "-1.2345678901234567e-123,"
  std::size_t bytes = 0;
  const auto add = [&](study::OutputFile& file, std::size_t columns, bool binary) {
    if (file.is_file()) bytes += columns * (binary ? sizeof(double) : kInText);
  };
  if (trajectory_) add(trajectory_->file(), trajectory_->columns().size(), is_npy(trajectory_->file().target()));
  if (reactions_) add(reactions_->file(), reactions_->columns().size(), is_npy(reactions_->file().target()));
  if (signals_) add(signals_->file(), signals_->columns().size(), is_npy(signals_->file().target()));
  return static_cast<double>(bytes);
}

void RunFiles::guarded(OutputFile& file, const std::function<void()>& act) {
  try {
    act();
  } catch (const OutputError& error) {
    interruption_requested = true;
    if (lost_.empty()) lost_ = error.what();
    torn_ = torn_ || file.is_file();
  }
}

void RunFiles::open_record() {
  try {
    if (!record_ && !record_name_.empty()) record_.emplace(record_name_);
  } catch (const std::exception&) {  // it is tried again at the end
  }
}

// The run is over: a record with no room would leave rows of which nothing says how they came to be.
void RunFiles::make_sure_of_the_record() {
  bool rows = false;
  with_files([&](OutputFile& file) { rows = rows || file.is_file(); });
  if (!rows || torn_) return;
  open_record();
  if (!record_ || record_->reserve(running_(unnamed_columns()).size() + kRecordGrows)) return;
  lost_ = cannot_be_written(record_name_, std::strerror(ENOSPC));
  torn_ = true;
}

void RunFiles::end_together() {
  std::vector<OutputFile*> files;
  with_files([&](OutputFile& file) {
    if (file.is_file()) files.push_back(&file);
  });
  std::int64_t lines = std::numeric_limits<std::int64_t>::max();
  for (const OutputFile* file : files) lines = std::min(lines, file->lines_given());
  open_record();
  const std::size_t record = record_ ? running_(unnamed_columns()).size() + kRecordGrows : 0;
  for (std::int64_t fewer = 1;; fewer = std::min(2 * fewer, 1 + lines / 8)) {
    bool room = true;
    for (OutputFile* file : files) room = file->end_at(lines) && room;
    if (room && (!record_ || record_->reserve(record))) break;
    if (lines == 0) break;
    lines = std::max<std::int64_t>(0, lines - fewer);
  }
  const char* const of = files.size() == 1 ? "it" : "all files";
  lost_ += lines < 2 ? fmt::format("; nothing of {} is kept", of)
                     : fmt::format("; what is kept of {} ends with row {}", of, lines - 1);
}

void RunFiles::with_files(const std::function<void(OutputFile&)>& act) {
  const auto with = [&](auto& writer) {
    if (writer) guarded(writer->file(), [&] { act(writer->file()); });
  };
  with(trajectory_);
  with(reactions_);
  with(signals_);
}

void RunFiles::write(const Sample& sample) {
  if (state_) state_->keep(sample);
  if (!any() || !lost_.empty()) return;
  const auto add = [&](auto& writer) {
    if (writer && lost_.empty()) guarded(writer->file(), [&] { writer->write(sample); });
  };
  add(trajectory_);
  add(reactions_);
  add(signals_);
  if (Clock::now() >= next_) flush();
}

void RunFiles::flush() {
  with_files(&OutputFile::flush);
  if (!under_way_ && record_) {
    try {
      record_->write(running_(unnamed_columns()));
      record_->commit();
    } catch (const OutputError&) {  // the record at the end may find room, and says it otherwise
    }
    record_.reset();
  }
  under_way_ = true;
  next_ = Clock::now() + kBetween;
}

void RunFiles::complete(bool ended) {
  if (reactions_) guarded(reactions_->file(), [&] { reactions_->end(); });
  with_files(&OutputFile::drain);
  make_sure_of_the_record();
  if (torn_) end_together();
  with_files(&OutputFile::complete);
  if (state_ && ended && lost_.empty())
    guarded(state_->file(), [&] {
      state_->write();
      state_->file().complete();
    });
  else if (state_ && ended)
    lost_ += "; the state at the end is not written";
  if (!ended || !lost_.empty()) state_.reset();
}

void RunFiles::commit(const std::string& record) {
  if (!record_name_.empty()) {  // whether it has its place is known before anything else takes its name
    try {
      if (!record_) record_.emplace(record_name_);
      record_->write(record);
      record_->complete();
    } catch (const std::exception& error) {  // what was computed is kept all the same
      if (lost_.empty()) lost_ = error.what();
      record_.reset();
    }
  }
  const std::string before = lost_;
  with_files(&OutputFile::commit);
  if (state_) guarded(state_->file(), [&] { state_->file().commit(); });
  if (record_ && lost_ == before) record_->commit();  // or it tells of files that are not there
}

}  // namespace poinsot::records
