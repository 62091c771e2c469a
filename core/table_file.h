// Two columns of a CSV file, as a scene names them for a table.
#pragma once

#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

namespace poinsot {

// The points in columns x and y, counted from 0. Fields are separated by commas, semicolons or tabs; empty lines and
// such as begin with # are passed over, and so are lines before the first number (a header). Throws InputError:
// "ramp.csv: line 7: column 2 holds 'abc', expected a number".
std::vector<std::pair<double, double>> read_columns(const std::filesystem::path& file, std::size_t x, std::size_t y);

}  // namespace poinsot
