#include "bench/study/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>

#include "bench/study/csv.h"
#include "bench/study/output_place.h"
#include "bench/study/temporary_file.h"
#include "core/input_error.h"

namespace poinsot::study {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBuffer = 1 << 20;

[[noreturn]] void refuse(const fs::path& target, std::string_view reason) {
  throw InputError(cannot_be_written(target, reason));
}

}  // namespace

std::string cannot_be_written(const fs::path& target, std::string_view reason) {
  return fmt::format("{}: cannot be written: {}", target == "-" ? "standard output" : target.string(), reason);
}

bool is_device(const fs::path& file) {
  const OutputPlace place = output_place(file);
  if (place.descriptor >= 0) return true;
  std::error_code error;
  const fs::file_status status = fs::status(place.path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

int open_descriptor(const fs::path& file) {
  return output_place(file).descriptor;
}

OutputFile::OutputFile(fs::path target, Content content) : target_(std::move(target)) {
  if (target_.empty()) refuse("output", "the file name is empty");
  const OutputPlace place = output_place(target_);
  std::error_code error;
  if (place.error != 0) refuse(target_, std::strerror(place.error));
  if (content == Content::binary && is_device(target_))
    refuse(target_, "a file that is no text cannot go to a device or pipe");
  if (place.descriptor >= 0) {
    std::fflush(stdout);  // in the order in which it was said
    descriptor_ = fcntl(place.descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  } else if (fs::is_directory(place.path, error) || !place.path.has_filename()) {
    refuse(target_, "it is a directory; give a file name");
  } else if (is_device(place.path)) {
    descriptor_ = open_device(place.path);
  } else {
    real_ = place.path;
    struct stat there {};  // a name that is too long would not be noticed before the end
    if (lstat(real_.c_str(), &there) != 0 && errno != ENOENT && errno != ENOTDIR) refuse(target_, std::strerror(errno));
    if (fs::exists(real_, error) && access(real_.c_str(), W_OK) != 0) refuse(target_, std::strerror(errno));
    const fs::path folder = target_.parent_path();
    if (!folder.empty()) folders_ = make_folders(folder);
    descriptor_ = open_temporary(real_, temporary_);
    regular_ = true;
  }
  if (descriptor_ < 0) {
    const int why = errno;
    remove_folders(folders_);
    refuse(target_, std::strerror(why));
  }
  buffer_.reserve(kBuffer + 4096);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (temporary_.empty()) return;
  unlink(temporary_.c_str());
  forget_temporary(temporary_);
  remove_folders(folders_);
}

void OutputFile::write(std::string_view text) {
  if (failed_) return;
  buffer_ += text;
  if (buffer_.size() >= kBuffer) drain();
}

void OutputFile::write(double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.begin(), digits.end(), value, std::chars_format::general, 17).ptr;
  write(std::string_view(digits.begin(), end));
}

void OutputFile::write_field(std::string_view text) {
  write(",");
  write(csv_field(text));
}

int OutputFile::put(std::string_view rest) {
  while (!rest.empty()) {
    const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    this->count(rest.substr(0, static_cast<std::size_t>(count)));
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  return renew_header();
}

int OutputFile::renew_header() {
  if (binary_.row == 0 || lines_ == 0) return 0;
  const std::string header = binary_.renewed(lines_ - 1);
  return pwrite(descriptor_, header.data(), header.size(), 0) < 0 ? errno : 0;
}

void OutputFile::cut() {
  size_ = line_end_;
  if (ftruncate(descriptor_, line_end_) != 0 || lseek(descriptor_, line_end_, SEEK_SET) < 0) lines_ = 0;
}

void OutputFile::drain() {
  if (failed_ || descriptor_ < 0) return;
  const std::int64_t before = size_;
  const int why = put(buffer_);
  if (why != 0 && regular_) {  // the rest, from the last whole line on, may find room yet: end_at()
    std::string torn(static_cast<std::size_t>(size_ - line_end_), '\0');
    const ssize_t got = pread(descriptor_, torn.data(), torn.size(), line_end_);
    buffer_.erase(0, static_cast<std::size_t>(size_ - before));
    buffer_.insert(0, torn, 0, static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    cut();
  } else {
    buffer_.clear();
  }
  if (why == 0) return;
  failed_ = true;
  throw OutputError(cannot_be_written(target_, std::strerror(why)));
}

void OutputFile::count(std::string_view written) {
  const std::int64_t before = size_, lines = lines_in(written);
  lines_ += lines;
  size_ += static_cast<std::int64_t>(written.size());
  if (lines == 0) return;
  line_end_ = binary_.row > 0 ? start_of(lines_) : before + static_cast<std::int64_t>(written.rfind('\n')) + 1;
}

std::int64_t OutputFile::lines_in(std::string_view text) const {
  if (binary_.row == 0) return std::count(text.begin(), text.end(), '\n');
  const auto header = static_cast<std::int64_t>(binary_.header), row = static_cast<std::int64_t>(binary_.row);
  const std::int64_t all = size_ + static_cast<std::int64_t>(text.size());
  return all < header ? 0 : 1 + (all - header) / row - lines_;
}

std::int64_t OutputFile::lines_given() const {
  return lines_ + lines_in(buffer_);
}

std::int64_t OutputFile::start_of(std::int64_t line) const {
  if (line == 0) return 0;
  if (binary_.row > 0)
    return static_cast<std::int64_t>(binary_.header + static_cast<std::size_t>(line - 1) * binary_.row);
  std::int64_t from = line_end_, behind = lines_ - line;  // lines that are passed on the way back
  std::array<char, 1 << 16> piece;
  while (from > 0) {
    const auto size = static_cast<ssize_t>(std::min<std::int64_t>(from, piece.size()));
    if (pread(descriptor_, piece.data(), static_cast<std::size_t>(size), from - size) != size) break;
    for (ssize_t k = size; k > 0; --k, --from)
      if (piece[static_cast<std::size_t>(k - 1)] == '\n' && behind-- == 0) return from;
  }
  return 0;
}

bool OutputFile::end_at(std::int64_t lines) {
  failed_ = true;
  if (lines <= lines_) {
    line_end_ = start_of(lines);
    lines_ = lines;
    buffer_.clear();
    cut();
    return renew_header() == 0;
  }
  std::size_t bytes = 0;  // of the buffer, which begins where the file ends
  if (binary_.row > 0)
    bytes = static_cast<std::size_t>(start_of(lines) - size_);
  else
    for (std::int64_t k = lines_; k < lines; ++k) bytes = buffer_.find('\n', bytes) + 1;
  const std::int64_t there = lines_, end = line_end_;
  if (put(std::string_view(buffer_).substr(0, bytes)) == 0) {
    buffer_.clear();
    return true;
  }
  lines_ = there;
  line_end_ = end;
  cut();
  return false;
}

bool OutputFile::reserve(std::size_t bytes) {
  const int why = posix_fallocate(descriptor_, size_, static_cast<off_t>(bytes));
  reserved_ = true;
  if (why != ENOSPC && why != EDQUOT) return true;
  cut();
  return false;
}

void OutputFile::publish() {
  if (temporary_.empty()) return;
  const bool named = std::rename(temporary_.c_str(), real_.c_str()) == 0;
  const int why = errno;
  if (!named) unlink(temporary_.c_str());
  forget_temporary(temporary_);
  temporary_.clear();
  folders_.clear();
  if (named) return;
  failed_ = true;
  throw OutputError(cannot_be_written(target_, std::strerror(why)));
}

void OutputFile::flush() {
  drain();
  publish();
}

void OutputFile::complete() {
  if (descriptor_ < 0) return;
  drain();
  if (reserved_) (void)!ftruncate(descriptor_, size_);
  const bool closed = close(descriptor_) == 0;
  descriptor_ = -1;
  if (!closed) throw OutputError(cannot_be_written(target_, std::strerror(errno)));
}

void OutputFile::commit() {
  complete();
  if (!failed_ || lines_ > 0) publish();
}

}  // namespace poinsot::study
