// The course of a study: what a process computes of it, kept row by row in its folder, and what it all comes to.
//
//   Computation computation(read_study("study.json"), {});
//   computation.compute();
//   std::vector<std::filesystem::path> written;
//   if (computation.complete()) computation.conclude(written);
//
// Computing goes on where an earlier one in the same folder stopped. The record beside the rows says from the start on
// that they are incomplete, and why where they could not be written. An interruption (core/interruption.h) ends it
// after the cases under way.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/cases/case_table.h"
#include "bench/cases/ranks.h"
#include "bench/study/cache.h"

namespace poinsot::cases {

// One of so many parts of a study, counted from 1.
struct Shard {
  int place = 1, places = 1;

  std::string name() const;  // of its files: "cases", "shard-1-of-4"
};

struct ComputationOptions {
  std::filesystem::path folder = "results";
  Shard shard;
  std::vector<std::string> merge;                     // compute nothing, but put these parts together (merge.h)
  int threads = 0;                                    // 0: one for each processor
  bool quick = false;                                 // a tenth of the cases
  bool fresh = false;                                 // also what the folder holds already
  std::filesystem::path cache = study::user_cache();  // of references
};

struct ComputationProgress {
  double done = 0, all = 0, before = 0;  // cases; before: there when it began
  double per_second = 0;
  std::int64_t failed = 0;
};

class Computation {
 public:
  // `ranks`: the processes that compute with this one, none where it is alone. Throws InputError.
  Computation(Study study, ComputationOptions options, Ranks* ranks = nullptr);

  // `told`: from the calling thread, several times a second. Throws study::OutputError.
  void compute(const std::function<void(const ComputationProgress&)>& told = {});

  std::int64_t there() const;  // of the cases selected, those with a row
  std::int64_t selected() const { return selection_.size(); }
  bool complete() const { return there() == selected(); }
  const Study& study() const { return study_; }
  const CaseTable& table() const { return table_; }
  std::int64_t failures() const { return table_.failures(selection_); }

  // The record of what is there, whether complete or not, and then what it was `ended_by`; and where it is, the table
  // and the pictures. `written`: the files for the user. Returns why pictures are missing.
  std::string conclude(std::vector<std::filesystem::path>& written, const std::string& ended_by = "") const;
  // For the user: "interrupted by SIGINT: 3 of 20 cases are there; the same command goes on with them".
  std::string unfinished(const std::string& ended_by) const;

 private:
  void compute_rest(const std::function<void(const ComputationProgress&)>& told);
  enum class State { running, ended };
  void write_record(State state, const std::string& why = "") const;

  ComputationOptions options_;
  Study study_;
  Selection selection_;
  CaseTable table_;
  Ranks* ranks_;
  int threads_ = 1, core_ = -1;
};

}  // namespace poinsot::cases
