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
#include <utility>
#include <vector>

namespace poinsot::study {

// What is written finds no place: a full disk, a limit, a reader that went away. The name of the file was right.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class Content { text, binary };

// Of a file that is no text: rows of so many bytes behind a header that says how many there are, and is made anew
// whenever what was written is put on the disk.
struct BinaryRows {
  std::size_t header = 0, row = 0;                   // bytes; no row: text, whose rows are its lines
  std::function<std::string(std::int64_t)> renewed;  // the header of so many rows
};

class OutputFile {
 public:
  // Throws InputError where the target cannot be written, and where one that is no text is a device.
  explicit OutputFile(std::filesystem::path target, Content content = Content::text);
  ~OutputFile();  // without flush() and commit() nothing remains
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void set_rows(BinaryRows binary) { binary_ = std::move(binary); }  // before anything is written
  // These throw OutputError, once: of a file that did not take everything its complete lines are kept, and what is
  // written to it later is not.
  void write(std::string_view text);
  void write(double value);                 // with 17 significant digits
  void write_field(std::string_view text);  // a comma and a field of a CSV header
  void drain();                             // what was written is on the disk
  void flush();                             // and stands under the target's name
  void complete();                          // nothing more is written
  void commit();                            // the target is complete; after an error it is what was kept, if anything

  // Of a file, where the disk is full. It ends with so many lines, the header counted, of those on the disk and of
  // those that found no room; false: nor do so few find room.
  bool end_at(std::int64_t lines);
  // The place of so many bytes is its own from now on; false: there is none.
  bool reserve(std::size_t bytes);

  const std::filesystem::path& target() const { return target_; }
  std::int64_t lines() const { return lines_; }  // on the disk, the header counted
  std::int64_t lines_given() const;              // and those that are not there yet or found no room
  bool is_file() const { return regular_; }
  bool failed() const { return failed_; }

 private:
  std::int64_t lines_in(std::string_view text) const;  // that follows what is on the disk
  std::int64_t start_of(std::int64_t line) const;      // on the disk
  int put(std::string_view text);                      // 0, or the system's error
  int renew_header();
  void cut();  // what was not a whole line
  void count(std::string_view written);
  void publish();

  BinaryRows binary_;
  std::filesystem::path target_, real_, temporary_;  // temporary_ is empty where the target itself is written
  std::vector<std::filesystem::path> folders_;       // made for it, the innermost first
  int descriptor_ = -1;
  bool regular_ = false, failed_ = false, reserved_ = false;
  std::int64_t size_ = 0, line_end_ = 0, lines_ = 0;  // bytes written, those of complete lines
  std::string buffer_;
};

// "FILE: cannot be written: reason".
std::string cannot_be_written(const std::filesystem::path& target, std::string_view reason);
// Whether it is written as it is: "-", a device, a pipe, a descriptor that stands open.
bool is_device(const std::filesystem::path& file);
// Of a name like /dev/stdout, or "-"; -1 of any other.
int open_descriptor(const std::filesystem::path& file);

}  // namespace poinsot::study
