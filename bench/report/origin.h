// Where the numbers of a folder come from, and with what reservations.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/report/results.h"

namespace poinsot::report {

// Each origin once; where the folder's tables have several of a kind, of which files those are that fewer have.
std::vector<std::pair<std::string, std::string>> origins(const Results& results);

// HTML: these; and what was interrupted or made in a reduced form, of which sentences and pictures are made like of all
// else.
std::string origin_block(const Results& results);
std::string reservations_block(const Results& results);

}  // namespace poinsot::report
