#include "bench/study/isolated_run.h"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>

#include "core/interruption.h"
#include "integrators/simulate.h"

namespace poinsot::study {
namespace {

// What comes through the pipe: figures or a short sentence.
struct Answer {
  RunFigures figures;
  char failure[400] = {};
};

double resident_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss);
}

Answer answer(const SceneGenerator& generator, int bodies, const Settings& settings) {
  using Clock = std::chrono::steady_clock;
  using Seconds = decltype(Statistics::seconds);
  Answer out;
  const auto fail = [&](const std::string& why) { std::strncpy(out.failure, why.c_str(), sizeof out.failure - 1); };
  try {
    const double before = resident_kilobytes();
    const Scene scene = generator.make(bodies);
    Settings untimed = settings;
    untimed.end = untimed.every = kUntimedSteps * settings.step;
    const Outcome first = simulate(scene, untimed, {});
    const auto began = Clock::now();
    const Outcome outcome = simulate(scene, settings, {});
    const double all = std::chrono::duration<double>(Clock::now() - began).count();
    if (!outcome.status.ok()) {
      fail(outcome.status.message);
      return out;
    }
    const Statistics &s = outcome.statistics, &s1 = first.statistics;
    const int made = static_cast<int>(scene.bodies.size());
    const double units = static_cast<double>(s.newton_iterations - s1.newton_iterations) * made * 1e-6;
    const auto later = [&](double Seconds::*phase) { return (s.seconds.*phase - s1.seconds.*phase) / units; };
    const double iterations = static_cast<double>(s.newton_iterations) * made * 1e-6 * later(&Seconds::total);
    out.figures = {.us_per_body = later(&Seconds::total),
                   .assembly = later(&Seconds::assembly),
                   .factor = later(&Seconds::factor),
                   .solve = later(&Seconds::solve),
                   .rest = later(&Seconds::other),
                   .start = all - iterations,
                   .kilobytes_per_body = (resident_kilobytes() - before) / made,
                   .seconds = all,
                   .bodies = made};
  } catch (const std::exception& error) {
    fail(error.what());
  }
  return out;
}

// Reads the answer; false where there is none, or an end is asked for before it comes.
bool get(int from, Answer& answer) {
  constexpr int kAsksAgain = 50;  // ms
  pollfd waited{from, POLLIN, 0};
  while (poll(&waited, 1, kAsksAgain) <= 0)
    if (interruption_requested) return false;
  return read(from, &answer, sizeof answer) == static_cast<ssize_t>(sizeof answer);
}

}  // namespace

IsolatedRun run_isolated(const SceneGenerator& generator, int bodies, const Settings& settings) {
  int ends[2];
  if (pipe(ends) != 0) return {{}, "no pipe could be made"};
  const pid_t child = fork();
  if (child < 0) return {{}, "no process could be made"};
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // interrupted with the program
    const Answer out = answer(generator, bodies, settings);
    const bool written = write(ends[1], &out, sizeof out) == static_cast<ssize_t>(sizeof out);
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  Answer got;
  const bool complete = get(ends[0], got);
  close(ends[0]);
  if (!complete) kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  if (!complete) return {{}, "the run ended without an answer (out of memory?)"};
  return {got.figures, got.failure};
}

}  // namespace poinsot::study
