// What nearly every test includes, compiled once for all of them (a third of the time that building them takes). Tests
// include what they use all the same: they build without it, too (CMAKE_DISABLE_PRECOMPILE_HEADERS).
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>
