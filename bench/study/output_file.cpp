#include "bench/study/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <csignal>
#include <cstring>

#include "core/input_error.h"

namespace poinsot::study {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBuffer = 1 << 20;

// Temporary files that are being written. A signal handler may neither allocate nor lock, so their paths lie here.
struct Unfinished {
  std::atomic<bool> active = false;
  char path[PATH_MAX] = {};
};
std::array<Unfinished, 32> unfinished;

extern "C" void remove_unfinished(int signal) {
  for (const Unfinished& file : unfinished)
    if (file.active) unlink(file.path);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void remember(const fs::path& file) {
  for (Unfinished& free : unfinished) {
    if (free.active || file.native().size() >= sizeof free.path) continue;
    std::strcpy(free.path, file.c_str());
    free.active = true;
    return;
  }
}

void forget(const fs::path& file) {
  for (Unfinished& one : unfinished)
    if (one.active && file == one.path) one.active = false;
}

[[noreturn]] void refuse(const fs::path& target, std::string_view reason) {
  throw InputError(fmt::format("{}: cannot be written: {}", target.string(), reason));
}

}  // namespace

void remove_unfinished_when_interrupted() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(signal, remove_unfinished) == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup stays in force
}

bool is_device(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

OutputFile::OutputFile(fs::path target) : target_(std::move(target)) {
  if (target_.empty()) refuse("output", "the file name is empty");
  if (fs::is_directory(target_)) refuse(target_, "it is a directory; give a file name");
  if (is_device(target_)) {
    descriptor_ = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    const fs::path real = fs::weakly_canonical(target_);  // through symbolic links: they stay what they are
    if (fs::exists(real) && access(real.c_str(), W_OK) != 0) refuse(target_, std::strerror(errno));
    temporary_ = real;
    temporary_ += fmt::format(".{}.partial", getpid());
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) remember(temporary_);
  }
  if (descriptor_ < 0) refuse(target_, std::strerror(errno));
  buffer_.reserve(kBuffer + 4096);
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  if (temporary_.empty()) return;
  unlink(temporary_.c_str());
  forget(temporary_);
}

void OutputFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBuffer) flush();
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

void OutputFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse(target_, std::strerror(errno));
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void OutputFile::commit() {
  flush();
  const int closed = close(descriptor_);
  descriptor_ = -1;
  if (temporary_.empty()) return;
  if (closed != 0 || std::rename(temporary_.c_str(), fs::weakly_canonical(target_).c_str()) != 0) {
    const int error = errno;
    unlink(temporary_.c_str());
    forget(temporary_);
    refuse(target_, std::strerror(error));
  }
  forget(temporary_);
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
