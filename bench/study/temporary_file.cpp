#include "bench/study/temporary_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstring>

namespace poinsot::study {
namespace fs = std::filesystem;
namespace {

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

}  // namespace

int open_temporary(const fs::path& real, fs::path& temporary) {
  std::uint64_t random = 0;
  if (getrandom(&random, sizeof random, 0) != sizeof random) return -1;
  const fs::path file = real.parent_path() / fmt::format(".poinsot-{:016x}", random);
  remember(file);  // before it is there: a signal may come between
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) {
    const int why = errno;
    forget_temporary(file);
    errno = why;
    return -1;
  }
  temporary = file;
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

void forget_temporary(const std::filesystem::path& file) {
  for (Unfinished& one : unfinished)
    if (one.owner == getpid() && file == one.path) one.owner = 0;
}

void remove_unfinished() noexcept {
  const pid_t self = getpid();
  for (const Unfinished& file : unfinished)
    if (file.owner == self) unlink(file.path);
}

}  // namespace poinsot::study
