// The rows of a study, kept as they come: an append-only file that a kill leaves whole but for the cases under way.
//
// A part (cases.part, shard-2-of-4.part) has notes ("# key: text") that say which program computed it, then a line for
// each case, written in one call:
//
//   CHECKSUM KEY NUMBER,scene,bodies,...        checksum of all that follows it, key of the case (study_file.h), after
//                                               which stands ! in the place of the blank where the case failed
//
// A torn last line and lines whose checksum is wrong are no rows: their cases are computed again. So is what a changed
// study asks for; cases that it still has, perhaps under another number, are not. In memory stand eight bytes a case.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "bench/cases/study_file.h"

namespace poinsot::cases {

// Whose cases a process computes: `place` of `places`, counted from 1; with `quick` a tenth of them, one in ten places
// along the longest dimension of the study (0, 11, 22, ...).
class Selection {
 public:
  Selection(const Study& study, bool quick, int place = 1, int places = 1);

  std::int64_t size() const { return size_; }
  std::int64_t at(std::int64_t k) const;  // the number of the k-th case

 private:
  static constexpr std::int64_t kStride = 10;
  std::int64_t all_ = 0, size_ = 0;
  std::int64_t inner_ = 1, length_ = 1, stride_ = 1;  // of the longest dimension: cases within a place, places
  std::int64_t first_ = 0, every_ = 1;
};

struct CaseRow {
  std::int64_t number = 0;
  std::string line;  // "CHECKSUM KEY NUMBER,...\n"
  bool failed = false;
};
CaseRow make_row(const Study& study, const Case& one, const std::string& fields, bool failed);
std::string header(const Study& study);  // of cases.csv

class CaseTable {
 public:
  // Of all numbers up to study.size(); none is there.
  explicit CaseTable(const Study& study);
  ~CaseTable();
  CaseTable(const CaseTable&) = delete;
  CaseTable& operator=(const CaseTable&) = delete;

  // Takes in the rows of a part; returns how many. `once`: a row that another part has, too, is an error. Throws
  // InputError where the file is no part, or one of another program.
  std::int64_t read(const std::filesystem::path& part, bool once);
  // Rows are appended to it from now on; nobody else may. Throws InputError.
  void open(const std::filesystem::path& part);

  bool has(std::int64_t number) const { return places_[static_cast<std::size_t>(number)] != kNone; }
  std::int64_t unused() const { return unused_; }    // rows read of cases that the study does not have
  std::int64_t damaged() const { return damaged_; }  // lines read that are no rows
  // Of the rows of a selection that are there.
  std::int64_t failures(const Selection& selection) const;
  // For several threads. Throws study::OutputError; the rows before stay.
  void add(const CaseRow& row);

  // The rows of a selection that are there, by number: cases.csv.
  void write(const Selection& selection, const std::filesystem::path& csv) const;
  std::string fields(std::int64_t number) const;  // of a row that is there: "NUMBER,..."

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  // Of a place: the part's number above whether the case failed, above its offset.
  static constexpr int kPartShift = 48, kFailedShift = 47;
  static constexpr std::uint64_t place_of(std::size_t part, std::uint64_t offset, bool failed) {
    return std::uint64_t{part} << kPartShift | std::uint64_t{failed} << kFailedShift | offset;
  }

  struct Part {
    std::filesystem::path file;
    int descriptor = -1;
  };
  void place(std::int64_t number, std::size_t part, std::uint64_t offset, bool failed, bool once);

  const Study& study_;
  std::vector<Part> parts_;
  std::vector<std::uint64_t> places_;
  std::int64_t unused_ = 0, damaged_ = 0;
  std::mutex writing_;
  std::size_t open_ = 0;  // the part appended to
  std::uint64_t end_ = 0;
};

}  // namespace poinsot::cases
