// What a run leaves: trajectory, reactions, signals, the state at its end and the record beside them, begun together
// and ended together.
//
// Rows go to files of other names until it is certain that there is a run (half a second of it); then the files take
// their names, a record says "running", and from there on what was computed stands in them, at most a second late:
// `tail -f FILE.csv` shows it. Where a file takes no more (a full disk) the run is asked to come to an end, and all
// files keep the same rows, as many as have room beside the record that says so.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/records/reactions_writer.h"
#include "bench/records/run_record.h"
#include "bench/records/signals_writer.h"
#include "bench/records/state_saver.h"
#include "bench/records/trajectory_writer.h"

namespace poinsot::records {

class RunFiles {
 public:
  struct Names {
    std::filesystem::path trajectory, reactions, signals, state, record;  // empty: not asked for
  };
  using RecordText = std::function<std::string(const ColumnsByOption& unnamed)>;
  // `running`: the record's text while the run goes on. Throws InputError.
  RunFiles(const Names& names, const Scene& scene, const TrajectoryContent& content, RecordText running);

  bool any() const { return trajectory_ || reactions_ || signals_; }  // that grow with the run
  ColumnsByOption unnamed_columns();                                  // complete when the run has begun
  // Bytes of a row of all files together, at most, by the columns known now; devices and pipes fill no disk.
  double longest_row();

  void write(const Sample& sample);
  void flush();
  // Nothing is written any more but the record; the state only of a run that came to its end.
  void complete(bool ended);
  void commit(const std::string& record);

  const std::string& lost() const { return lost_; }  // why a file did not take everything; empty: all did

 private:
  // What a file does not take is remembered, and the run asked to end.
  void guarded(study::OutputFile& file, const std::function<void()>& act);
  // Does it with every file that grows.
  void with_files(const std::function<void(study::OutputFile&)>& act);
  void open_record();
  void make_sure_of_the_record();
  void end_together();

  using Clock = std::chrono::steady_clock;
  std::optional<TrajectoryWriter> trajectory_;
  std::optional<ReactionsWriter> reactions_;
  std::optional<SignalsWriter> signals_;
  std::optional<StateSaver> state_;
  std::filesystem::path record_name_;
  std::optional<study::OutputFile> record_;
  RecordText running_;
  Clock::time_point next_;
  bool under_way_ = false;  // files have their names, and the record that says so stands
  bool torn_ = false;       // a file did not take everything
  std::string lost_;
};

}  // namespace poinsot::records
