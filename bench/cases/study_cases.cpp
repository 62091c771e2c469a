#include <fmt/format.h>

#include <bit>
#include <iterator>

#include "bench/cases/study_file.h"
#include "bench/study/cache.h"

namespace poinsot::cases {

std::int64_t Study::size() const {
  double all = static_cast<double>(scenes.size()) * static_cast<double>(settings.size());
  for (const ParameterAxis& axis : axes) all *= static_cast<double>(axis.size());
  return all > 1e15 ? static_cast<std::int64_t>(1e15) : static_cast<std::int64_t>(all);
}

Case case_of(const Study& study, std::int64_t number) {
  Case one;
  one.number = number;
  const auto digit = [&](std::int64_t size) {
    const std::int64_t k = number % size;
    number /= size;
    return k;
  };
  one.settings = static_cast<std::size_t>(digit(static_cast<std::int64_t>(study.settings.size())));
  std::vector<std::int64_t> places(study.axes.size());
  for (std::size_t a = study.axes.size(); a-- > 0;) places[a] = digit(study.axes[a].size());
  for (std::size_t a = 0; a < study.axes.size(); ++a) study.axes[a].append(places[a], one.parameters);
  one.scene = static_cast<std::size_t>(number);
  return one;
}

std::vector<std::string> parameter_names(const Study& study) {
  std::vector<std::string> names;
  for (const ParameterAxis& axis : study.axes) names.insert(names.end(), axis.names.begin(), axis.names.end());
  return names;
}

std::uint64_t key_of(const Study& study, const Case& one) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{:x} {:x} {}", study.scenes[one.scene].hash, study.settings[one.settings].hash,
                 study.repetitions);
  for (const double value : one.parameters) fmt::format_to(out, " {:x}", std::bit_cast<std::uint64_t>(value));
  return study::content_hash({text.data(), text.size()}) ^ study.columns_hash;
}

}  // namespace poinsot::cases
