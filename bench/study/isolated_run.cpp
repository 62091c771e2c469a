#include "bench/study/isolated_run.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>

#include "core/input_error.h"
#include "integrators/simulate.h"

namespace poinsot::study {
namespace {

// What comes through the pipe: plain numbers and a short sentence.
struct Answer {
  bool ok = false;
  double numbers[8] = {};
  int bodies = 0;
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
    Settings first_step = settings;
    first_step.end = first_step.every = settings.step;
    const Outcome first = simulate(scene, first_step, {});
    const auto began = Clock::now();
    const Outcome outcome = simulate(scene, settings, {});
    const double all = std::chrono::duration<double>(Clock::now() - began).count();
    if (!outcome.status.ok()) {
      fail(outcome.status.message);
      return out;
    }
    const Statistics &s = outcome.statistics, &s1 = first.statistics;
    out.bodies = static_cast<int>(scene.bodies.size());
    const double units = static_cast<double>(s.newton_iterations - s1.newton_iterations) * out.bodies * 1e-6;
    const auto later = [&](double Seconds::*phase) { return (s.seconds.*phase - s1.seconds.*phase) / units; };
    const double numbers[] = {later(&Seconds::total),
                              later(&Seconds::assembly),
                              later(&Seconds::factor),
                              later(&Seconds::solve),
                              later(&Seconds::other),
                              all - s.seconds.total + s1.seconds.total,
                              (resident_kilobytes() - before) / out.bodies,
                              all};
    std::copy(std::begin(numbers), std::end(numbers), std::begin(out.numbers));
    out.ok = true;
  } catch (const std::exception& error) {
    fail(error.what());
  }
  return out;
}

}  // namespace

IsolatedRun run_isolated(const SceneGenerator& generator, int bodies, const Settings& settings) {
  int ends[2];
  if (pipe(ends) != 0) return {"no pipe could be made"};
  const pid_t child = fork();
  if (child < 0) return {"no process could be made"};
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // interrupted with the program
    const Answer out = answer(generator, bodies, settings);
    const bool written = write(ends[1], &out, sizeof out) == static_cast<ssize_t>(sizeof out);
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  Answer got;
  const bool complete = read(ends[0], &got, sizeof got) == static_cast<ssize_t>(sizeof got);
  close(ends[0]);
  waitpid(child, nullptr, 0);
  IsolatedRun run;
  if (!complete) {
    run.failure = "the run ended without an answer (out of memory?)";
  } else if (!got.ok) {
    run.failure = got.failure;
  } else {
    const double* n = got.numbers;
    run = {"", n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], got.bodies};
  }
  return run;
}

}  // namespace poinsot::study
