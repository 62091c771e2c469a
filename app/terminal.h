// What is written for a person: errors and notices on stderr, colours on a terminal only and never against NO_COLOR.
#pragma once

#include <string_view>

namespace poinsot::app {

enum ExitStatus : int { kDone = 0, kInternalError = 1, kWrongInput = 2, kNumericsFailed = 3 };

bool stderr_is_terminal();
void print_error(std::string_view sentence);   // "poinsot: ..."
void print_notice(std::string_view sentence);  // "poinsot: note: ..."

}  // namespace poinsot::app
