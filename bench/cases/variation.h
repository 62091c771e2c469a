// What varies from case to case: a value of parameters along one dimension of a study.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bench/cases/random.h"
#include "core/json_value.h"

namespace poinsot::cases {

struct Distribution {
  enum Kind { uniform, normal } kind = uniform;
  double a = 0, b = 1;  // uniform: from, to; normal: mean, standard deviation

  double at(double p) const;  // the quantile
};

// Values of one parameter (a list, a range), or samples of several.
struct ParameterAxis {
  std::vector<std::string> names;
  std::vector<double> values;               // of the only parameter; empty: samples
  std::vector<Distribution> distributions;  // by parameter
  std::int64_t samples = 0;
  bool latin_hypercube = false;  // one sample in each n-th of every parameter's distribution
  std::uint64_t seed = 0;
  std::uint32_t stream = 0;  // of the first parameter

  std::int64_t size() const { return values.empty() ? samples : static_cast<std::int64_t>(values.size()); }
  // Of the k-th place, appended by parameter.
  void append(std::int64_t k, std::vector<double>& out) const;
};

// {"from": a, "to": b, "count": n, "spacing": "linear" | "logarithmic"} of an axis: the values, ends included.
std::vector<double> read_range(const JsonValue& axis);
// {"samples": n, "sampling": "independent" | "latin_hypercube", "parameters": {NAME: {"uniform": [from, to]},
// NAME: {"normal": {"mean": m, "deviation": s}}}}
ParameterAxis read_samples(const JsonValue& axis, std::uint64_t seed, std::uint32_t stream);
// The items of an array of at least so many. As every place, `list` lives on while they are used.
std::vector<JsonValue> items(const JsonValue& list, std::string_view allowed, std::size_t least = 0);
// A whole number from `least` to `most`.
std::int64_t read_count(const JsonValue& value, std::int64_t least, std::int64_t most);

}  // namespace poinsot::cases
