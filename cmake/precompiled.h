// What most files include, compiled once for each target: a third of the time that building takes. Files include what
// they use all the same: they build without it, too (CMAKE_DISABLE_PRECOMPILE_HEADERS).
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
