// Fields of CSV files: taken apart as csv_field() of bench/study/output_file.h puts them together.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace poinsot::study {

std::vector<std::string> csv_fields(std::string_view line);

}  // namespace poinsot::study
