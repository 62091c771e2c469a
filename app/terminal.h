// What is written: errors and notices for a person on stderr, colours on a terminal only and never against NO_COLOR;
// JSON for programs.
#pragma once

#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace poinsot::app {

enum ExitStatus : int { kDone = 0, kWrongInput = 2, kNumericsFailed = 3 };

bool stderr_is_terminal();
// Nothing is thrown where stderr takes nothing.
void print_error(std::string_view sentence) noexcept;   // "poinsot: ..."
void print_notice(std::string_view sentence) noexcept;  // "poinsot: note: ..."

// The message with the line of each key path in it, as the scene's file stands now.
std::string with_lines_of(const std::string& scene_file, std::string_view message);

// What a command says with --json; the keys are in README.md. Names may hold bytes that are not UTF-8.
void print_json(std::FILE* out, const nlohmann::ordered_json& json);

// Where text for a person goes: stdout, or stderr where one of the outputs is the standard output.
std::FILE* text_stream(std::initializer_list<std::filesystem::path> outputs);

}  // namespace poinsot::app
