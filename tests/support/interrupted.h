// The program when it is interrupted or finds no room, as the user of the tests and, where that is root, as nobody.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "../command_line.h"

namespace poinsot::test {

class Interrupted : public CommandLine, public testing::WithParamInterface<const char*> {
 protected:
  Interrupted() { write("pendulum.json", kPendulum); }
  void SetUp() override {
    if (std::string_view(GetParam()) == "nobody" && !become_nobody())
      GTEST_SKIP() << "the tests are not run by root: as whom they run is tested";
  }

  template <class Condition>
  static bool wait_for(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition() && std::chrono::steady_clock::now() < deadline) usleep(2000);
    return condition();
  }

  bool exists(const std::string& file) const { return std::filesystem::exists(folder() / file); }
  std::uintmax_t size(const std::string& file) const {
    return exists(file) ? std::filesystem::file_size(folder() / file) : 0;
  }

  void expect_complete_rows(const std::string& file) const {
    const std::string text = read(file);
    ASSERT_FALSE(text.empty()) << file;
    EXPECT_EQ(text.back(), '\n') << file;
    const std::vector<std::string> rows = lines(text);
    for (const std::string& row : rows) ASSERT_EQ(fields(row).size(), fields(rows[0]).size()) << file << row;
  }

  // Files of other names, at any depth.
  std::vector<std::string> leftovers() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder()))
      if (entry.path().filename().string().starts_with(".poinsot") || entry.path().extension() == ".partial")
        found.push_back(entry.path());
    return found;
  }

  // The whole of a command in the folder, as a shell takes it; POINSOT is the program.
  int shell(const std::string& commands) const {
    const std::string as = program() == POINSOT_PROGRAM ? "" : "setpriv --reuid=65534 --regid=65534 --clear-groups ";
    const std::string line = fmt::format("cd '{}' && export POINSOT='{}' && {}bash -c '{}' 2> .said.shell",
                                         folder().string(), program(), as, commands);
    const int status = std::system(line.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

inline constexpr const char* kUsers[] = {"tester", "nobody"};

inline std::string name_of_user(const testing::TestParamInfo<const char*>& test) {
  return test.param;
}

}  // namespace poinsot::test
