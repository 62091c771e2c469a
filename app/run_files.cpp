#include "app/run_files.h"

#include <fmt/format.h>

#include "core/interruption.h"

namespace poinsot::app {
using namespace study;
namespace {

constexpr std::chrono::milliseconds kBetween{500};

}  // namespace

RunFiles::RunFiles(const Names& names, const Scene& scene, std::function<std::string()> running)
    : record_name_(names.record), running_(std::move(running)), next_(Clock::now() + kBetween) {
  if (!names.trajectory.empty()) trajectory_.emplace(names.trajectory, scene);
  if (!names.reactions.empty()) reactions_.emplace(names.reactions, compile(scene));
  if (!record_name_.empty()) record_.emplace(record_name_);
}

std::vector<OutputFile*> RunFiles::files() {
  std::vector<OutputFile*> all;
  if (trajectory_) all.push_back(&trajectory_->file());
  if (reactions_) all.push_back(&reactions_->file());
  return all;
}

void RunFiles::with_files(const std::function<void(OutputFile&)>& act) {
  for (OutputFile* file : files()) {
    try {
      act(*file);
    } catch (const OutputError& error) {
      interruption_requested = true;
      if (!lost_.empty()) continue;
      lost_ = error.what();
      if (!is_device(file->target()))
        lost_ += file->lines() < 2 ? "; nothing of it is kept"
                                   : fmt::format("; what is kept of it ends with row {}", file->lines() - 1);
    }
  }
}

void RunFiles::write(const Sample& sample) {
  if (!any() || !lost_.empty()) return;
  with_files([&](OutputFile& file) {
    if (trajectory_ && &file == &trajectory_->file())
      trajectory_->write(sample);
    else
      reactions_->write(sample);
  });
  if (Clock::now() >= next_) flush();
}

void RunFiles::flush() {
  with_files([](OutputFile& file) { file.flush(); });
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

void RunFiles::complete() {
  with_files([](OutputFile& file) { file.complete(); });
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
  with_files([](OutputFile& file) { file.commit(); });
  if (record_) record_->commit();
}

}  // namespace poinsot::app
