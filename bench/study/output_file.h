// A result file: written under another name beside the target and renamed to it when it is complete, so that a target
// is either as it was or whole. A result that grows with a run takes its name at the first flush() and is from then on
// as long as what was computed.
//
// "-", devices, pipes, sockets and descriptors that stand open (/dev/stdout, whatever is behind it) are written as they
// are: nothing is made beside them. Missing folders are made; a file that was there keeps its owner and mode.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace poinsot::study {

// What is written finds no place: a full disk, a limit, a reader that went away. The name of the file was right.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file that is no text: rows of so many bytes behind a header that says how many there are, and is made anew whenever
// what was written is put on the disk.
struct BinaryRows {
  std::size_t header = 0, row = 0;                   // bytes; no row: text, whose rows are its lines
  std::function<std::string(std::int64_t)> renewed;  // the header of so many rows
};

class OutputFile {
 public:
  // Throws InputError where the target cannot be written, and where one that is no text is a device.
  explicit OutputFile(std::filesystem::path target, BinaryRows binary = {});
  ~OutputFile();  // without flush() and commit() nothing remains
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // These throw OutputError, once: of a file that did not take everything its complete lines are kept, and what is
  // written to it later is not.
  void write(std::string_view text);
  void write(double value);                 // with 17 significant digits
  void write_field(std::string_view text);  // a comma and a field of a CSV header, quoted also where a
                                            // spreadsheet would take it for a formula
  void flush();                             // what was written stands under the target's name
  void complete();                          // what was written is on the disk, under either name
  void commit();                            // the target is complete; after an error it is what was kept

  const std::filesystem::path& target() const { return target_; }
  std::int64_t lines() const { return lines_; }  // on the disk, the header counted

 private:
  void write_out();
  void count(std::string_view written);
  void publish();

  BinaryRows binary_;
  std::filesystem::path target_, real_, temporary_;  // temporary_ is empty where the target itself is written
  std::vector<std::filesystem::path> folders_;       // made for it, the innermost first
  int descriptor_ = -1;
  bool regular_ = false, failed_ = false;
  std::int64_t size_ = 0, line_end_ = 0, lines_ = 0;  // bytes written, those of complete lines
  std::string buffer_;
};

// Removes the files that are not complete: for handlers of signals, it neither allocates nor locks.
void remove_unfinished() noexcept;

// Whether it is written as it is: "-", a device, a pipe, a descriptor that stands open.
bool is_device(const std::filesystem::path& file);
// Of a name like /dev/stdout, or "-"; -1 of any other.
int open_descriptor(const std::filesystem::path& file);
// A field of CSV, quoted where it has to be.
std::string csv_field(std::string_view text);

}  // namespace poinsot::study
