#include "bench/view/trajectory_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/study/csv.h"
#include "bench/view/trajectory_columns.h"
#include "core/input_error.h"
#include "core/json_document.h"
#include "core/so3.h"

namespace poinsot::view {
namespace {

constexpr double kNoRotation = 1e-3;  // how far from 1 the norm of Euler parameters in a file may be

void check_header(const std::string& file, const std::string& line, const Scene& scene) {
  const std::vector<std::string> found = study::csv_fields(line);
  std::size_t column = 0;
  const auto hold_to = [&](const std::string& expected) {
    if (column >= found.size())
      throw InputError(fmt::format("{}: found {} columns, expected \"{}\" next: not a trajectory of scene \"{}\"", file,
                                   found.size(), expected, scene.name));
    if (found[column] != expected)
      throw InputError(fmt::format("{}: column {}: found \"{}\", expected \"{}\": not a trajectory of scene \"{}\"",
                                   file, column + 1, found[column], expected, scene.name));
    ++column;
  };
  hold_to("t");
  for (const Body& body : scene.bodies)
    for (const std::string_view name : kTrajectoryColumns) hold_to(fmt::format("{}.{}", body.name, name));
  if (column < found.size())
    throw InputError(fmt::format("{}: column {}: found \"{}\", expected nothing more: not a trajectory of scene \"{}\"",
                                 file, column + 1, found[column], scene.name));
}

// The numbers of a line. Throws InputError where one is not a finite number, or their count is another.
void read_numbers(const std::string& place, std::string_view line, std::vector<double>& numbers) {
  const char *at = line.data(), *const end = line.data() + line.size();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto [next, error] = std::from_chars(at, end, numbers[k]);
    const bool last = k + 1 == numbers.size();
    if (error != std::errc() || !std::isfinite(numbers[k]) || (last ? next != end : next == end || *next != ','))
      throw InputError(fmt::format("{}: field {}: expected a number, {} in all", place, k + 1, numbers.size()));
    at = next + (last ? 0 : 1);
  }
}

BodyState state(std::span<const double, 19> x, const std::string& place) {
  BodyState body;
  const Vec4<double> p(x[3], x[4], x[5], x[6]);
  if (std::abs(p.norm() - 1) > kNoRotation)
    throw InputError(fmt::format("{}: found Euler parameters of norm {:g}, expected 1", place, p.norm()));
  body.r = {x[0], x[1], x[2]};
  body.A = rotation_from_parameters<double>(p.normalized());
  body.rd = {x[7], x[8], x[9]};
  body.w = {x[10], x[11], x[12]};
  body.rdd = {x[13], x[14], x[15]};
  body.wd = {x[16], x[17], x[18]};
  return body;
}

}  // namespace

void read_trajectory(const std::filesystem::path& file, const Scene& scene,
                     const std::function<void(double, std::span<const BodyState>)>& row) {
  const std::string name = file.string();
  std::ifstream in = open_input(name);
  std::string line;
  if (!std::getline(in, line)) throw InputError(fmt::format("{}: the file is empty", name));
  if (line.starts_with("\x93NUMPY"))
    throw InputError(
        fmt::format("{}: found an array of NumPy, expected the CSV that `poinsot run --out FILE.csv` writes", name));
  check_header(name, line, scene);

  constexpr std::size_t kColumns = kTrajectoryColumns.size();
  std::vector<double> numbers(1 + scene.bodies.size() * kColumns);
  std::vector<BodyState> bodies(scene.bodies.size());
  double before = -std::numeric_limits<double>::infinity();
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    const std::string place = fmt::format("{}: line {}", name, number);
    read_numbers(place, line, numbers);
    if (numbers[0] <= before)
      throw InputError(
          fmt::format("{}: found t = {:g} after {:g}, expected times that grow", place, numbers[0], before));
    before = numbers[0];
    for (std::size_t b = 0; b < bodies.size(); ++b)
      bodies[b] = state(std::span<const double, kColumns>(&numbers[1 + b * kColumns], kColumns), place);
    row(before, bodies);
  }
  if (!std::isfinite(before)) throw InputError(fmt::format("{}: found no rows, expected one or more", name));
}

RecordedRun recorded_run(const std::filesystem::path& file, const Scene& scene) try {
  using Record = nlohmann::json;  // whose keys have no order
  constexpr bool kThrows = true, kComments = true;
  RecordedRun run;
  std::ifstream in(std::filesystem::path(file).replace_extension(".run.json"), std::ios::binary);
  const Record record = Record::parse(in);
  if (record.value("incomplete", false)) run.incomplete = record.value("message", "the run did not come to its end");
  // Parameters by their values, however they are written.
  std::vector<std::string> values, sections;
  const Record then = record.value("/parameters/values"_json_pointer, Record::object());
  for (const Parameter& now : scene.parameters)
    if (const double before = then.value(now.name, now.value); before != now.value)
      values.push_back(fmt::format("{} = {}, not {}", now.name, before, now.value));
  const Record own = Record::parse(scene.source, nullptr, kThrows, kComments), other = record.value("scene", own);
  std::vector<const char*> told{"gravity", "bodies", "constraints", "joints", "drivers", "forces", "tables"};
  if (then.empty()) told.push_back("parameters");  // in the records of references, which hold no values
  for (const char* key : told)
    if (other.value(key, Record()) != own.value(key, Record())) sections.push_back(key);
  if (!values.empty())
    run.otherwise = fmt::format("computed with {}", fmt::join(values, ", "));
  else if (!sections.empty())
    run.otherwise = fmt::format("computed of a scene of other {}", fmt::join(sections, ", "));
  return run;
} catch (const nlohmann::json::exception&) {  // none, or no record of a run
  return {};
}

}  // namespace poinsot::view
