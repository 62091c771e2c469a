#include "bench/study/plot.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <vector>

#include "bench/study/program_data.h"

namespace poinsot::study {
namespace fs = std::filesystem;
namespace {

// Exit status of a script where matplotlib is missing (bench/study/plots/plotting.py), and of a program that is not
// there.
constexpr int kNoMatplotlib = 3, kNotFound = 127;

struct Ended {
  int status = -1;  // of exit; -1 where a signal ended it or it could not be started
  std::string said;
};

// Runs a program and waits for it; keeps what it says on both outputs.
Ended run_program(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // interrupted with the program
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    execvp(argv[0], argv.data());
    _exit(kNotFound);
  }
  close(ends[1]);
  Ended ended;
  char text[4096];
  for (ssize_t n = 0; (n = read(ends[0], text, sizeof text)) > 0 || (n < 0 && errno == EINTR);)
    if (n > 0) ended.said.append(text, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status)) ended.status = WEXITSTATUS(status);
  return ended;
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);  // npos + 1 is 0
}

}  // namespace

std::string draw(std::string_view script, std::span<const Plot> plots) {
  const std::string file = fmt::format("{}.py", script);
  const auto places = program_data("plots", "bench/study/plots");
  const fs::path folder = fs::exists(places[0] / file) ? places[0] : places[1];
  if (!fs::exists(folder / file))
    return fmt::format("no picture was drawn: {} is neither in {} nor in {}", file, places[0].string(),
                       places[1].string());
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    std::vector<std::string> command{python, "-B", (folder / file).string()};  // -B: leaves no compiled scripts behind
    for (const Plot& plot : plots) command.insert(command.end(), {plot.csv.string(), plot.stem.string()});
    const Ended ended = run_program(command);
    if (ended.status == 0) return {};
    if (ended.status != kNoMatplotlib && ended.status != kNotFound)
      return fmt::format("not every picture was drawn, {} failed: {}", file, last_line(ended.said));
  }
  return "no picture was drawn: that needs Python 3 with matplotlib (Debian: python3-matplotlib); the CSV is there";
}

}  // namespace poinsot::study
