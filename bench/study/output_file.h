// A result file: written to a temporary name beside the target and renamed to it when it is complete, so that a target
// is either as it was or whole. Devices and pipes (/dev/stdout) are written directly.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace poinsot::study {

class OutputFile {
 public:
  // Throws InputError where the target cannot be written.
  explicit OutputFile(std::filesystem::path target);
  ~OutputFile();  // without commit() nothing remains
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view text);
  // A number with 17 significant digits.
  void write(double value);
  void write_field(std::string_view text);  // a comma and a field of a CSV header
  void commit();                            // throws InputError where the disk does not take it

  const std::filesystem::path& target() const { return target_; }

 private:
  void flush();

  std::filesystem::path target_, temporary_;  // temporary_ is empty for devices
  int descriptor_ = -1;
  std::string buffer_;
};

// From now on a run that is interrupted (Ctrl-C, a hangup) removes the temporary files it was writing. For programs: it
// takes SIGINT, SIGTERM and SIGHUP where they are not ignored.
void remove_unfinished_when_interrupted();

bool is_device(const std::filesystem::path& file);
// A field of a CSV header, quoted where it has to be.
std::string csv_field(std::string_view text);

}  // namespace poinsot::study
