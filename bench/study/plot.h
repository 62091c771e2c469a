// Drawing: a CSV file becomes an SVG and a PNG by a matplotlib script of bench/study/plots, which computes nothing.
//
// A script is called with pairs CSV STEM and writes STEM.svg and STEM.png; what all have in common is in
// bench/study/plots/plotting.py. Tried are the python3 on the PATH and, where that has no matplotlib, the system's.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace poinsot::study {

struct Plot {
  std::filesystem::path csv;
  std::filesystem::path stem;  // of the pictures: without .svg and .png
};

// Draws all with bench/study/plots/SCRIPT.py, in one process. Empty, or a sentence that says why there are no pictures
// and what to do; the CSV files are as they were.
[[nodiscard]] std::string draw(std::string_view script, std::span<const Plot> plots);

}  // namespace poinsot::study
