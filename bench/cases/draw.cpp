#include "bench/cases/draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "bench/study/csv.h"
#include "bench/study/panels.h"
#include "bench/study/range.h"
#include "core/counted.h"

namespace poinsot::cases {
using study::csv_number;
using study::Curve;
using study::PanelPlot;
using study::Table;
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The table's rows, one after the other.
class Rows {
 public:
  Rows(const Study& study, const Selection& selection, const CaseTable& table)
      : columns_(study::csv_fields(header(study))), selection_(selection), table_(table) {}

  std::size_t column(const std::string& name) const {
    return static_cast<std::size_t>(std::ranges::find(columns_, name) - columns_.begin());
  }
  template <class Take>
  void for_each(const Take& take) const {
    for (std::int64_t k = 0; k < selection_.size(); ++k)
      if (const std::int64_t n = selection_.at(k); table_.has(n)) take(study::csv_fields(table_.fields(n)));
  }

 private:
  std::vector<std::string> columns_;
  const Selection& selection_;
  const CaseTable& table_;
};

struct Drawn {
  PanelPlot plot;
  Table table;
};

Drawn begin(const Picture& picture, const std::string& x, const std::string& y) {
  Drawn drawn{{picture.file, picture.title, x, y}, {picture.file + "_table", picture.title, "", {}, {}}};
  drawn.plot.log_x = picture.log_x;
  drawn.plot.log_y = picture.log_y;
  drawn.plot.columns = 1;
  return drawn;
}

std::string text(double x) {
  return fmt::format("{:.6g}", x);
}

// Whether points follow one another along x: places of a dimension of the study, each of them once in a curve. What is
// drawn at random, or a result itself, makes a cloud.
bool follow_x(const Study& study, const std::string& x, const std::vector<Curve>& curves) {
  const std::vector<std::string> results = study.kept.columns();
  if (std::ranges::find(results, x) != results.end()) return false;
  for (const ParameterAxis& axis : study.axes)
    if (axis.values.empty() && std::ranges::find(axis.names, x) != axis.names.end()) return false;
  return std::ranges::all_of(curves, [](const Curve& curve) {
    return std::ranges::adjacent_find(curve.points, std::ranges::equal_to(), &study::Point::x) == curve.points.end();
  });
}

Drawn histogram(const Picture& picture, const Rows& rows) {
  Drawn drawn = begin(picture, picture.x, "cases");
  const std::size_t column = rows.column(picture.x);
  std::vector<double> values;
  rows.for_each([&](const std::vector<std::string>& row) {
    if (const double x = csv_number(row[column]); std::isfinite(x)) values.push_back(x);
  });
  std::ranges::sort(values);
  drawn.table.header = {"column", "cases", "mean", "deviation", "least", "5 %", "median", "95 %", "greatest"};
  if (values.empty()) return drawn;
  const double low = values.front(), width = (values.back() - low) / picture.bins;
  std::vector<int> counts(static_cast<std::size_t>(picture.bins));
  double mean = 0, square = 0;
  for (const double x : values) {
    const double bin = width > 0 ? (x - low) / width : 0;
    ++counts[std::min(static_cast<std::size_t>(bin), counts.size() - 1)];
    mean += x / static_cast<double>(values.size());
  }
  for (const double x : values) square += (x - mean) * (x - mean);
  const auto n = static_cast<double>(values.size());
  const auto quantile = [&](double p) { return text(values[static_cast<std::size_t>(std::lround(p * (n - 1)))]); };
  drawn.table.rows = {{picture.x, fmt::format("{}", values.size()), text(mean),
                       text(n > 1 ? std::sqrt(square / (n - 1)) : 0), text(low), quantile(0.05), quantile(0.5),
                       quantile(0.95), text(values.back())}};
  Curve curve{"", picture.x, "", {}};
  for (std::size_t k = 0; k < counts.size(); ++k)
    for (const std::size_t edge : {k, k + 1})
      curve.points.push_back({low + width * static_cast<double>(edge), static_cast<double>(counts[k])});
  if (!picture.log_y) {  // counts stand on zero
    curve.points.insert(curve.points.begin(), {low, 0});
    curve.points.push_back({values.back(), 0});
  }
  drawn.plot.curves = {curve};
  return drawn;
}

Drawn points(const Picture& picture, const Rows& rows, const Study& study) {
  Drawn drawn = begin(picture, picture.x, picture.y);
  const std::size_t x = rows.column(picture.x), y = rows.column(picture.y), series = rows.column(picture.series);
  std::map<std::string, Curve> curves;
  rows.for_each([&](const std::vector<std::string>& row) {
    const std::string name = picture.series.empty() ? picture.y : row[series];
    const double at = csv_number(row[x]), value = csv_number(row[y]);
    if (!std::isfinite(at) || !std::isfinite(value)) return;
    curves.try_emplace(name, Curve{"", name, "", {}}).first->second.points.push_back({at, value});
  });
  drawn.table.header = {"series", "cases", "least", "greatest"};
  for (auto& [name, curve] : curves) {
    std::ranges::stable_sort(curve.points, {}, &study::Point::x);
    study::Range range;
    for (const study::Point& point : curve.points) range.add(point.y);
    drawn.table.rows.push_back({name, fmt::format("{}", curve.points.size()), text(range.low), text(range.high)});
    drawn.plot.curves.push_back(std::move(curve));
  }
  drawn.plot.joined = follow_x(study, picture.x, drawn.plot.curves);
  return drawn;
}

Drawn curves(const Picture& picture, const Rows& rows, const Kept& kept, const Selection& selection) {
  constexpr std::int64_t kMost = 7;  // curves that can be told apart, and named below them
  const std::string name = picture.series.empty() ? "case" : picture.series;
  Drawn drawn = begin(picture, picture.x, picture.y);
  const std::vector<double>& times = std::ranges::find(kept.quantities, picture.x, &Quantity::name)->at;
  const std::size_t x = rows.column(Kept::at_name(picture.x, times.front())),
                    y = rows.column(Kept::at_name(picture.y, times.front())), series = rows.column(name);
  const std::int64_t every = std::max<std::int64_t>(1, (selection.size() + kMost - 1) / kMost);
  drawn.table.header = {name, "least x", "greatest x", "least y", "greatest y"};
  std::int64_t count = 0;
  rows.for_each([&](const std::vector<std::string>& row) {
    const double label = csv_number(row[series]);
    Curve curve{
        "", fmt::format("{} {}", name, std::isfinite(label) ? fmt::format("{:.4g}", label) : row[series]), "", {}};
    study::Range across, up;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const double at = csv_number(row[x + k]), value = csv_number(row[y + k]);
      if (!std::isfinite(at) || !std::isfinite(value)) return;
      curve.points.push_back({at, value});
      across.add(at);
      up.add(value);
    }
    drawn.table.rows.push_back({row[series], text(across.low), text(across.high), text(up.low), text(up.high)});
    if (count++ % every == 0) drawn.plot.curves.push_back(std::move(curve));
  });
  return drawn;
}

Drawn ratio(const Picture& picture, const Rows& rows, const Study& study) {
  Drawn drawn = begin(picture, picture.x, fmt::format("{} relative to {} {}", picture.y, picture.by, picture.to));
  const std::size_t x = rows.column(picture.x), y = rows.column(picture.y), by = rows.column(picture.by);
  // What else tells cases apart.
  std::vector<std::size_t> others{rows.column("scene")};
  for (const std::vector<std::string>& names : {parameter_names(study), study.settings_varied})
    for (const std::string& name : names)
      if (name != picture.by) others.push_back(rows.column(name));
  struct Compared {
    double x = kNone;
    std::map<std::string, double> y;  // by value of the setting
  };
  std::map<std::string, Compared> all;
  rows.for_each([&](const std::vector<std::string>& row) {
    std::string key;
    for (const std::size_t column : others) key += row[column] + "\n";
    const double value = csv_number(row[y]);
    if (!(value > 0)) return;
    all[key].x = csv_number(row[x]);
    all[key].y[row[by]] = value;
  });
  std::map<std::string, Curve> curves;
  std::map<std::string, std::vector<double>> ratios;
  for (const auto& [key, compared] : all) {
    const auto base = compared.y.find(picture.to);
    if (base == compared.y.end()) continue;
    for (const auto& [name, value] : compared.y) {
      if (name == picture.to) continue;
      const double r = value / base->second;
      curves.try_emplace(name, Curve{"", name, "", {}}).first->second.points.push_back({compared.x, r});
      ratios[name].push_back(r);
    }
  }
  drawn.table.text = fmt::format(
      "{} relative to that of {} {} in cases that differ in nothing else: geometric mean and "
      "its 95 % confidence interval.",
      picture.y, picture.by, picture.to);
  drawn.table.header = {picture.by, "cases", "ratio", "from", "to", "least", "greatest"};
  for (auto& [name, curve] : curves) {
    std::ranges::stable_sort(curve.points, {}, &study::Point::x);
    const GeometricMean mean = geometric_mean(ratios[name]);
    const auto [least, greatest] = std::ranges::minmax(ratios[name]);
    drawn.table.rows.push_back({name, fmt::format("{}", ratios[name].size()), fmt::format("{:.3f}", mean.mean),
                                fmt::format("{:.3f}", mean.low), fmt::format("{:.3f}", mean.high),
                                fmt::format("{:.3f}", least), fmt::format("{:.3f}", greatest)});
    drawn.plot.curves.push_back(std::move(curve));
  }
  drawn.plot.joined = follow_x(study, picture.x, drawn.plot.curves);
  return drawn;
}

Drawn drawn(const Picture& picture, const Rows& rows, const Study& study, const Selection& selection) {
  switch (picture.kind) {
    case Picture::histogram:
      return histogram(picture, rows);
    case Picture::points:
      return points(picture, rows, study);
    case Picture::curves:
      return curves(picture, rows, study.kept, selection);
    case Picture::ratio:
      break;
  }
  return ratio(picture, rows, study);
}

}  // namespace

double student_95(int degrees) {
  constexpr double p = 0.975;
  if (degrees <= 1) return std::tan(std::numbers::pi * (p - 0.5));
  if (degrees == 2) return (2 * p - 1) / std::sqrt(2 * p * (1 - p));
  const double z = normal_quantile(p), z2 = z * z, v = degrees;
  const double terms[] = {z, z * (z2 + 1) / 4, z * ((5 * z2 + 16) * z2 + 3) / 96,
                          z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384,
                          z * ((((79 * z2 + 776) * z2 + 1482) * z2 - 1920) * z2 - 945) / 92160};
  double sum = 0, power = 1;
  for (const double term : terms) {
    sum += term * power;
    power /= v;
  }
  return sum;
}

GeometricMean geometric_mean(const std::vector<double>& ratios) {
  const auto n = static_cast<double>(ratios.size());
  double mean = 0, square = 0;
  for (const double r : ratios) mean += std::log(r) / n;
  if (ratios.size() < 2) return {std::exp(mean), 0, std::numeric_limits<double>::infinity()};
  for (const double r : ratios) square += (std::log(r) - mean) * (std::log(r) - mean);
  const double half = student_95(static_cast<int>(ratios.size()) - 1) * std::sqrt(square / (n - 1) / n);
  return {std::exp(mean), std::exp(mean - half), std::exp(mean + half)};
}

std::string draw_pictures(const Study& study, const Selection& selection, const CaseTable& table,
                          const std::filesystem::path& directory, const std::vector<std::string>& foot,
                          std::vector<std::filesystem::path>& written) {
  if (study.pictures.empty()) return "";
  const Rows rows(study, selection, table);
  study::Report report{study.name.empty() ? "Study" : study.name, study.about, {}, foot};
  if (const std::int64_t failed = table.failures(selection); failed > 0)
    report.text += fmt::format("{}Of {} {} failed: numbers and pictures are of the others.",
                               report.text.empty() ? "" : "\n\n", counted(selection.size(), "case"), failed);
  std::vector<PanelPlot> plots;
  for (const Picture& picture : study.pictures) {
    Drawn one = drawn(picture, rows, study, selection);
    one.table.text = fmt::format("![{}]({}.svg)\n\n{}", picture.title, picture.file, one.table.text);
    report.tables.push_back(std::move(one.table));
    if (!one.plot.curves.empty()) plots.push_back(std::move(one.plot));
  }
  std::string why = study::write_plots(plots, directory, foot);
  for (const std::filesystem::path& file : study::write_report(report, directory, "study")) written.push_back(file);
  return why;
}

}  // namespace poinsot::cases
