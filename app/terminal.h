// What is written for a person: errors and notices on stderr, colours on a terminal only and never against NO_COLOR.
#pragma once

#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace poinsot::app {

enum ExitStatus : int { kDone = 0, kWrongInput = 2, kNumericsFailed = 3 };

bool stderr_is_terminal();
// Nothing is thrown where stderr takes nothing.
void print_error(std::string_view sentence) noexcept;   // "poinsot: ..."
void print_notice(std::string_view sentence) noexcept;  // "poinsot: note: ..."

// Where text for a person goes: stdout, or stderr where one of the outputs is the standard output.
std::FILE* text_stream(std::initializer_list<std::filesystem::path> outputs);

}  // namespace poinsot::app
