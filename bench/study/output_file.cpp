#include "bench/study/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstring>

#include "bench/study/output_place.h"
#include "core/input_error.h"

namespace poinsot::study {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBuffer = 1 << 20;

// Temporary files that are being written. A signal handler may neither allocate nor lock, so their paths lie here.
struct Unfinished {
  std::atomic<pid_t> owner = 0;  // not a process that was made of it since
  char path[PATH_MAX] = {};
};
std::array<Unfinished, 32> unfinished;

void remember(const fs::path& file) {
  constexpr pid_t kTaken = -1;  // until the path stands there: another thread may look for a place, too
  for (Unfinished& free : unfinished) {
    pid_t nobody = 0;
    if (file.native().size() >= sizeof free.path || !free.owner.compare_exchange_strong(nobody, kTaken)) continue;
    std::strcpy(free.path, file.c_str());
    free.owner = getpid();
    return;
  }
}

void forget(const fs::path& file) {
  for (Unfinished& one : unfinished)
    if (one.owner == getpid() && file == one.path) one.owner = 0;
}

std::string shown(const fs::path& target) {
  return target == "-" ? "standard output" : target.string();
}

std::string cannot_be_written(const fs::path& target, std::string_view reason) {
  return fmt::format("{}: cannot be written: {}", shown(target), reason);
}

[[noreturn]] void refuse(const fs::path& target, std::string_view reason) {
  throw InputError(cannot_be_written(target, reason));
}

// Makes what is missing of a folder; returns what was made, the innermost first.
std::vector<fs::path> make_folders(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path part = folder; !part.empty() && !fs::exists(part, error); part = part.parent_path())
    missing.push_back(part);
  fs::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: the folder cannot be made: {}", folder.string(), error.message()));
  return missing;
}

void remove_folders(const std::vector<fs::path>& folders) {
  std::error_code error;  // one that others have put something into stays
  for (const fs::path& folder : folders) fs::remove(folder, error);
}

// A socket in the file system is not opened but connected to.
int open_device(const fs::path& file) {
  sockaddr_un address{};
  if (!fs::is_socket(file) || file.native().size() >= sizeof address.sun_path)
    return open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, file.c_str());
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0 || connect(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0)
    return descriptor;
  const int why = errno;
  close(descriptor);
  errno = why;
  return -1;
}

// With the owner and mode of the file it takes the place of, or those of a new one.
int open_beside(const fs::path& real, fs::path& temporary) {
  std::string name = (real.parent_path() / ".poinsot-XXXXXX").string();
  const int descriptor = mkostemp(name.data(), O_CLOEXEC | O_NOFOLLOW);  // and O_EXCL
  if (descriptor < 0) return -1;
  temporary = name;
  remember(temporary);
  struct stat before {};
  if (stat(real.c_str(), &before) == 0) {
    [[maybe_unused]] const int allowed = fchown(descriptor, before.st_uid, before.st_gid);  // to few
    fchmod(descriptor, before.st_mode & 07777);
  } else {
    const mode_t mask = umask(0);
    umask(mask);
    fchmod(descriptor, 0666 & ~mask);
  }
  return descriptor;
}

}  // namespace

void remove_unfinished() noexcept {
  const pid_t self = getpid();
  for (const Unfinished& file : unfinished)
    if (file.owner == self) unlink(file.path);
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

OutputFile::OutputFile(fs::path target, BinaryRows binary) : binary_(std::move(binary)), target_(std::move(target)) {
  if (target_.empty()) refuse("output", "the file name is empty");
  const OutputPlace place = output_place(target_);
  std::error_code error;
  if (place.error != 0) refuse(target_, std::strerror(place.error));
  if (binary_.row > 0 && is_device(target_)) refuse(target_, "a file that is no text cannot go to a device or pipe");
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
    descriptor_ = open_beside(real_, temporary_);
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
  forget(temporary_);
  remove_folders(folders_);
}

void OutputFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBuffer) write_out();
}

void OutputFile::write(double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.begin(), digits.end(), value, std::chars_format::general, 17).ptr;
  write(std::string_view(digits.begin(), end));
}

void OutputFile::write_field(std::string_view text) {
  write(",");
  const bool formula = !text.empty() && std::string_view("=+-@").find(text.front()) != std::string_view::npos;
  const std::string field = csv_field(text);
  write(formula && field == text ? fmt::format("\"{}\"", field) : field);
}

void OutputFile::write_out() {
  std::string_view rest = failed_ ? std::string_view() : buffer_;
  int why = 0;
  while (!rest.empty() && why == 0) {
    const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
    if (count < 0) {
      why = errno == EINTR ? 0 : errno;
      continue;
    }
    const std::string_view written = rest.substr(0, static_cast<std::size_t>(count));
    this->count(written);
    rest.remove_prefix(written.size());
  }
  buffer_.clear();
  if (binary_.row > 0 && lines_ > 0 && !failed_) {
    const std::string header = binary_.renewed(lines_ - 1);
    if (pwrite(descriptor_, header.data(), header.size(), 0) < 0 && why == 0) why = errno;
  }
  if (why == 0) return;
  failed_ = true;
  if (regular_ && ftruncate(descriptor_, line_end_) != 0) lines_ = 0;
  throw OutputError(cannot_be_written(target_, std::strerror(why)));
}

void OutputFile::count(std::string_view written) {
  const std::int64_t before = size_;
  size_ += static_cast<std::int64_t>(written.size());
  if (binary_.row > 0) {
    const auto header = static_cast<std::int64_t>(binary_.header), row = static_cast<std::int64_t>(binary_.row);
    if (size_ < header) return;
    lines_ = 1 + (size_ - header) / row;
    line_end_ = header + (lines_ - 1) * row;
    return;
  }
  if (const std::size_t last = written.rfind('\n'); last != std::string_view::npos)
    line_end_ = before + static_cast<std::int64_t>(last) + 1;
  lines_ += std::count(written.begin(), written.end(), '\n');
}

void OutputFile::publish() {
  if (temporary_.empty()) return;
  const bool named = std::rename(temporary_.c_str(), real_.c_str()) == 0;
  const int why = errno;
  if (!named) unlink(temporary_.c_str());
  forget(temporary_);
  temporary_.clear();
  folders_.clear();
  if (named) return;
  failed_ = true;
  throw OutputError(cannot_be_written(target_, std::strerror(why)));
}

void OutputFile::flush() {
  write_out();
  publish();
}

void OutputFile::complete() {
  if (descriptor_ < 0) return;
  write_out();
  const bool closed = close(descriptor_) == 0;
  descriptor_ = -1;
  if (!closed) throw OutputError(cannot_be_written(target_, std::strerror(errno)));
}

void OutputFile::commit() {
  complete();
  publish();
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + '"';
}

}  // namespace poinsot::study
