// The parts that shards of a study wrote, put together.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/cases/case_table.h"

namespace poinsot::cases {

// The files named, and those of the folders named that end in .part. Throws InputError where one is named twice, or
// none is there.
std::vector<std::filesystem::path> parts_in(const std::vector<std::string>& named);

// Takes in the rows of all. Throws InputError where a case stands in two of them, or in none.
void merge(const std::vector<std::filesystem::path>& parts, const Selection& selection, CaseTable& table);

}  // namespace poinsot::cases
