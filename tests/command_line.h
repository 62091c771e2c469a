// Runs the program as a user does, in a folder of its own, and keeps what it says and what it leaves.
#pragma once

#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace poinsot::test {

struct Result {
  int status = -1;
  std::string out, err;
};

inline std::string read(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("no file " + file.string());
  return std::string(std::istreambuf_iterator<char>(in), {});
}

// A line of CSV, taken apart; the tests' own names need no quotes.
inline std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> result;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) result.push_back(field);
  return result;
}

inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::stringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

class CommandLine : public testing::Test {
 protected:
  CommandLine() {
    std::string pattern = (std::filesystem::temp_directory_path() / "poinsot-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no folder for the test");
    folder_ = pattern;
  }
  ~CommandLine() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder() const { return folder_; }
  std::string program() const { return program_; }

  // From now on the program runs as nobody, and the files of the test are nobody's; false where the test is no root.
  bool become_nobody() {
    namespace fs = std::filesystem;
    if (geteuid() != 0) return false;
    program_ = folder_ / ".said.poinsot";  // where nobody may not go it stands elsewhere
    fs::copy_file(POINSOT_PROGRAM, program_);
    fs::permissions(program_, fs::perms(0755));
    user_ = kNobody;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) give(entry.path());
    give(folder_);
    return true;
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    give(folder_ / name);
  }
  std::string read(const std::string& name) const { return test::read(folder_ / name); }
  nlohmann::json read_json(const std::string& name) const { return nlohmann::json::parse(read(name)); }

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (!entry.path().filename().string().starts_with(".said")) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  // `poinsot ARGUMENTS` in the folder; returns its process.
  pid_t start(const std::vector<std::string>& arguments, const std::string& tag = "") const {
    const std::string out = (folder_ / (".said.out" + tag)).string(), err = (folder_ / (".said.err" + tag)).string();
    std::vector<const char*> argv{program_.c_str()};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    for (int number = 1; number < NSIG; ++number) signal(number, SIG_DFL);  // also where the tests ignore some
    if (chdir(folder_.c_str()) != 0) _exit(127);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
    if (user_ == kNobody && (setgroups(0, nullptr) != 0 || setgid(user_) != 0 || setuid(user_) != 0)) _exit(127);
    execv(argv[0], const_cast<char* const*>(argv.data()));
    _exit(127);
  }

  Result finish(pid_t child, const std::string& tag = "") const {
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(".said.out" + tag), read(".said.err" + tag)};
  }

  Result poinsot(const std::vector<std::string>& arguments) const { return finish(start(arguments)); }

  // A command line as a shell takes it, in the folder, as the user of the test; `poinsot` is the program.
  int shell(const std::string& command) const {
    const std::string script = ".said.commands", as = user_ == kNobody && geteuid() == 0
                                                          ? "setpriv --reuid=65534 --regid=65534 --clear-groups "
                                                          : "";
    write(script, "poinsot() { '" + program_ + "' \"$@\"; }\n" + command + "\n");
    const int status = std::system(("cd '" + folder_.string() + "' && " + as + "bash " + script).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  static constexpr uid_t kNobody = 65534;

  void give(const std::filesystem::path& file) const {
    if (user_ == kNobody && chown(file.c_str(), user_, user_) != 0) throw std::runtime_error("cannot be nobody's");
  }

  std::filesystem::path folder_;
  std::string program_ = POINSOT_PROGRAM;
  uid_t user_ = geteuid();
};

// Whether pictures can be drawn. Where they cannot, commands that draw say so and end with 3; the numbers are there.
inline bool pictures_are_drawn() {
  static const bool drawn =
      std::system(
          "(for p in python3 /usr/bin/python3; do $p -c 'import matplotlib' && exit 0; done; exit 1) "
          "2> /dev/null") == 0;
  return drawn;
}

inline void expect_drawn(const Result& result) {
  EXPECT_EQ(result.status, pictures_are_drawn() ? 0 : 3) << result.err;
  EXPECT_TRUE(pictures_are_drawn() || result.err.find("matplotlib") != std::string::npos) << result.err;
}

// A rod of 2 m on a hinge at the origin, horizontal at rest, swinging about x.
inline const char* const kPendulum = R"({
  "scene": 1,
  "name": "pendulum", // a comment
  "gravity": [0, 0, -9.81],
  "bodies": [{"name": "rod", "mass": 3, "inertia": [1, "1/100", 1], "position": [0, 1, 0]}],
  "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}]
})";

// With it in the folder.
class CommandLineWithPendulum : public CommandLine {
 protected:
  CommandLineWithPendulum() { write("pendulum.json", kPendulum); }
};

// The same rod pulled about by a telescope from (0, 3, 0), which from t = 1 on is too long for it: at t = 1 rod and
// telescope are stretched out in line.
inline const char* const kOverstretched = R"({
  "scene": 1,
  "name": "overstretched",
  "gravity": [0, 0, -9.81],
  "bodies": [{"name": "rod", "mass": 3, "inertia": [1, "1/100", 1], "position": [0, 0, -1],
              "orientation": {"axis": [1, 0, 0], "angle": "-pi/2"}}],
  "joints": [{"type": "revolute", "bodies": ["ground", "rod"], "point": [0, 0, 0], "axis": [1, 0, 0]}],
  "drivers": [{"type": "distance", "name": "telescope", "bodies": ["ground", "rod"], "s_i": [0, 3, 0], "s_j": [0, 1, 0],
               "length": "sqrt(13) + (5 - sqrt(13))*t"}]
})";

// Two constraints that cannot hold together.
inline const char* const kConflicting = R"({
  "scene": 1,
  "name": "conflicting",
  "bodies": [{"name": "ball", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]}],
  "constraints": [
    {"type": "CD", "bodies": ["ground", "ball"], "c": [1, 0, 0], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "f": 1},
    {"type": "CD", "bodies": ["ground", "ball"], "c": [1, 0, 0], "s_i": [0, 0, 0], "s_j": [0, 0, 0], "f": "1 + t"}]
})";

}  // namespace poinsot::test
