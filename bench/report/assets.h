// Style and script of the page, bench/report/page/*, as CMake has put them into the program.
#pragma once

#include <string_view>

namespace poinsot::report {

extern const std::string_view kStyle, kScript;

}  // namespace poinsot::report
