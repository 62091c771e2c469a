// The pictures of a study, and what they show in numbers: DIR/study.md with its tables.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/cases/case_table.h"

namespace poinsot::cases {

// Of the rows that are there. Returns why pictures are missing, empty where none is; what was written is added to
// `written`. Throws InputError where files cannot be written.
std::string draw_pictures(const Study& study, const Selection& selection, const CaseTable& table,
                          const std::filesystem::path& directory, const std::vector<std::string>& foot,
                          std::vector<std::filesystem::path>& written);

// The geometric mean of ratios, and its 95 % confidence interval; of one ratio alone there is none, and low is 0, high
// infinite.
struct GeometricMean {
  double mean = 0, low = 0, high = 0;
};
GeometricMean geometric_mean(const std::vector<double>& ratios);
// Of Student's distribution with so many degrees of freedom: x with P(|t| < x) = 0.95. From 3 on by the expansion in
// 1/ν of Abramowitz and Stegun, 26.7.5, to 1e-3 and better.
double student_95(int degrees);

}  // namespace poinsot::cases
