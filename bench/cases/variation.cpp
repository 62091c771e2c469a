#include "bench/cases/variation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace poinsot::cases {
namespace {

constexpr std::int64_t kMost = 1'000'000'000;  // along one dimension

Distribution read_distribution(const JsonValue& value) {
  value.keys("a distribution", {"uniform", "normal"});
  const auto uniform = value.optional("uniform"), normal = value.optional("normal");
  if (uniform.has_value() == normal.has_value()) value.expected("one of \"uniform\", \"normal\"");
  if (uniform) {
    constexpr std::string_view kEnds = "an array of 2 numbers, from and to, the second one greater";
    if (uniform->size(kEnds) != 2) uniform->expected(kEnds);
    const JsonValue from = uniform->at(0), to = uniform->at(1);
    const Distribution d{Distribution::uniform, from.number(), to.number()};
    if (!(d.a < d.b)) uniform->expected(kEnds);
    return d;
  }
  normal->keys("a normal distribution", {"mean", "deviation"});
  const JsonValue mean = normal->required("mean"), deviation = normal->required("deviation");
  const Distribution d{Distribution::normal, mean.number(), deviation.number()};
  if (!(d.b > 0)) deviation.expected("a number greater than 0");
  return d;
}

}  // namespace

double Distribution::at(double p) const {
  return kind == uniform ? a + (b - a) * p : a + b * normal_quantile(p);
}

void ParameterAxis::append(std::int64_t k, std::vector<double>& out) const {
  const auto at = static_cast<std::uint64_t>(k);
  if (!values.empty()) {
    out.push_back(values[at]);
    return;
  }
  for (std::size_t d = 0; d < distributions.size(); ++d) {
    const RandomStream random{seed, stream + static_cast<std::uint32_t>(d)};
    double p = random.uniform(at);
    if (latin_hypercube) {
      const auto n = static_cast<std::uint64_t>(samples);
      p = (static_cast<double>(random.permuted(at, n)) + p) / static_cast<double>(n);
      p = std::min(p, 1 - 0x1p-53);  // rounded up at the end of the last one
    }
    out.push_back(distributions[d].at(p));
  }
}

std::vector<JsonValue> items(const JsonValue& list, std::string_view allowed, std::size_t least) {
  std::vector<JsonValue> all;
  for (std::size_t k = 0; k < list.size(allowed); ++k) all.push_back(list.at(k));
  if (all.size() < least) list.expected(allowed);
  return all;
}

std::int64_t read_count(const JsonValue& value, std::int64_t least, std::int64_t most) {
  const std::string allowed = fmt::format("a whole number from {} to {}", least, most);
  const double number = value.number(allowed);
  if (number != std::floor(number) || number < static_cast<double>(least) || number > static_cast<double>(most))
    value.expected(allowed);
  return static_cast<std::int64_t>(number);
}

std::vector<double> read_range(const JsonValue& axis) {
  const JsonValue from = axis.required("from"), to = axis.required("to"), count = axis.required("count");
  const double a = from.number(), b = to.number();
  const std::int64_t n = read_count(count, 2, kMost);
  bool logarithmic = false;
  if (const auto spacing = axis.optional("spacing")) {
    constexpr std::string_view kAllowed = "\"linear\" or \"logarithmic\"";
    logarithmic = spacing->string(kAllowed) == "logarithmic";
    if (!logarithmic && spacing->string() != "linear") spacing->expected(kAllowed);
  }
  if (logarithmic && !(a > 0)) from.expected("a number greater than 0, as the spacing is logarithmic");
  if (logarithmic && !(b > 0)) to.expected("a number greater than 0, as the spacing is logarithmic");
  if (a == b) to.expected("another number than \"from\"");
  std::vector<double> values;
  for (std::int64_t k = 0; k < n; ++k) {
    const double s = static_cast<double>(k) / static_cast<double>(n - 1);
    const double between = logarithmic ? a * std::pow(b / a, s) : std::lerp(a, b, s);
    values.push_back(k == 0 ? a : k == n - 1 ? b : between);
  }
  return values;
}

ParameterAxis read_samples(const JsonValue& axis, std::uint64_t seed, std::uint32_t stream) {
  axis.keys("samples", {"samples", "sampling", "parameters"});
  ParameterAxis result;
  const JsonValue samples = axis.required("samples"), parameters = axis.required("parameters");
  result.samples = read_count(samples, 1, kMost);
  result.seed = seed;
  result.stream = stream;
  if (const auto sampling = axis.optional("sampling")) {
    constexpr std::string_view kAllowed = "\"independent\" or \"latin_hypercube\"";
    result.latin_hypercube = sampling->string(kAllowed) == "latin_hypercube";
    if (!result.latin_hypercube && sampling->string() != "independent") sampling->expected(kAllowed);
  }
  result.names = parameters.names("an object of distributions by parameter");
  if (result.names.empty()) parameters.expected("at least one distribution by parameter");
  for (const std::string& name : result.names) {
    const JsonValue distribution = parameters.required(name);
    result.distributions.push_back(read_distribution(distribution));
  }
  return result;
}

}  // namespace poinsot::cases
