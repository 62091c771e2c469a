// What a run leaves: trajectory, reactions and the record beside them, begun together and ended together.
//
// Rows go to files of other names until it is certain that there is a run (half a second of it); then the files take
// their names, a record says "running", and from there on what was computed stands in them, at most a second late:
// `tail -f FILE.csv` shows it. A file that takes no more (a full disk) keeps its complete rows, and the run is asked to
// come to an end.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/reactions_writer.h"
#include "app/trajectory_writer.h"

namespace poinsot::app {

class RunFiles {
 public:
  struct Names {
    std::filesystem::path trajectory, reactions, record;  // empty: not asked for
  };
  // `running`: the record's text while the run goes on. Throws InputError.
  RunFiles(const Names& names, const Scene& scene, std::function<std::string()> running);

  bool any() const { return trajectory_ || reactions_; }

  void write(const Sample& sample);
  void flush();
  // Nothing is written any more but the record.
  void complete();
  void commit(const std::string& record);

  const std::string& lost() const { return lost_; }  // why a file did not take everything; empty: all did

 private:
  std::vector<study::OutputFile*> files();
  // Does it with every file; what one does not take is remembered.
  void with_files(const std::function<void(study::OutputFile&)>& act);

  using Clock = std::chrono::steady_clock;
  std::optional<TrajectoryWriter> trajectory_;
  std::optional<ReactionsWriter> reactions_;
  std::filesystem::path record_name_;
  std::optional<study::OutputFile> record_;
  std::function<std::string()> running_;  // empty once it is written
  Clock::time_point next_;
  std::string lost_;
};

}  // namespace poinsot::app
