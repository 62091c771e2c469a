#include "app/signals.h"

#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

#include "bench/study/temporary_file.h"
#include "core/interruption.h"

namespace poinsot::app {
namespace {

struct Caught {
  int number;
  const char *name, *about;
  bool insists;  // of one who wants an end: the others come again by themselves
};
constexpr std::array kSignals{
    Caught{SIGINT, "SIGINT", "", true},
    Caught{SIGTERM, "SIGTERM", "", true},
    Caught{SIGQUIT, "SIGQUIT", "", true},
    Caught{SIGHUP, "SIGHUP", ", the terminal was closed", false},
    Caught{SIGPIPE, "SIGPIPE", ", nobody reads the output any more", false},
    Caught{SIGXFSZ, "SIGXFSZ", ", a file reached the largest size allowed", false},
    Caught{SIGXCPU, "SIGXCPU", ", the processor time allowed is spent", false},
    Caught{SIGALRM, "SIGALRM", "", false},
    Caught{SIGVTALRM, "SIGVTALRM", "", false},
    Caught{SIGPROF, "SIGPROF", "", false},
    Caught{SIGUSR1, "SIGUSR1", "", false},
    Caught{SIGUSR2, "SIGUSR2", "", false},
};

pid_t program = 0;                        // not a child that only measures
std::atomic<int> deferrals{0}, first{0};  // first: the signal that came first while deferred
std::atomic<long long> first_at{0};       // ns

const Caught& entry(int number) {
  for (const Caught& one : kSignals)
    if (one.number == number) return one;
  return kSignals.front();
}

// Nothing here allocates or locks.
extern "C" void handle(int number) {
  if (getpid() != program) _exit(128 + number);
  if (deferrals > 0) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const long long at = 1'000'000'000LL * now.tv_sec + now.tv_nsec;
    int none = 0;
    if (first.compare_exchange_strong(none, number)) {
      first_at = at;
      interruption_requested = true;
      return;
    }
    if (!entry(number).insists || at - first_at < 1'000'000'000LL) return;  // `timeout` sends its signal twice
  }
  study::remove_unfinished();
  if (number != SIGPIPE) {
    const Caught& caught = entry(number);
    for (const char* text : {"poinsot: interrupted by ", caught.name, caught.about, "\n"})
      if (write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  }
  _exit(128 + number);
}

}  // namespace

void catch_signals() {
  program = getpid();
  for (const Caught& one : kSignals) {
    struct sigaction before {};
    if (sigaction(one.number, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = handle;
    action.sa_flags = SA_RESTART;
    sigaction(one.number, &action, nullptr);
  }
}

Deferred::Deferred() {
  ++deferrals;
}
Deferred::~Deferred() {
  --deferrals;
}

int caught_signal() {
  return first;
}

std::string signal_text() {
  return fmt::format("interrupted by {}{}", entry(first).name, entry(first).about);
}

int signal_status() {
  return 128 + first;
}

}  // namespace poinsot::app
