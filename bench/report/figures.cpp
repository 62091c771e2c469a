#include "bench/report/figures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "bench/report/html.h"
#include "bench/report/svg_panel.h"
#include "bench/study/chart_file.h"
#include "bench/study/cost_curve.h"
#include "bench/study/panels.h"
#include "core/index.h"
#include "formulations/registry.h"
#include "integrators/integrator.h"

namespace poinsot::report {
using namespace study;
namespace {

constexpr std::size_t kCourse = 50;  // more points are a course, not measurements at places of their own

// In the order of appearance.
int place(std::vector<std::string>& names, const std::string& name) {
  const auto it = std::ranges::find(names, name);
  if (it != names.end()) return static_cast<int>(it - names.begin());
  names.push_back(name);
  return static_cast<int>(names.size()) - 1;
}

// The colours of curves by their names: integrators have one each, the same in all pictures of a page.
std::vector<int> colours_of(const std::vector<std::string>& names) {
  std::vector<std::string> all = integrators().names();
  const bool are_integrators =
      std::ranges::all_of(names, [](const std::string& name) { return integrators().find(name) != nullptr; });
  if (!are_integrators) all = names;
  std::vector<int> colours;
  for (const std::string& name : names) colours.push_back(place(all, name));
  return colours;
}

// What colours and markers mean: a list, but for its end.
std::string key_items(const std::vector<std::string>& names, const std::vector<std::string>& markers) {
  constexpr const char* shapes[] = {"●", "■", "▲", "◆"};
  std::string html = "<ul class=\"key\" aria-label=\"Key\">";
  const std::vector<int> colours = colours_of(names);
  for (std::size_t k = 0; k < names.size(); ++k)
    html += fmt::format("<li><span class=\"chip c{}\" aria-hidden=\"true\"></span>{}</li>", colours[k] % kColours,
                        escape(names[k]));
  for (std::size_t k = 0; k < markers.size(); ++k)
    html += fmt::format("<li><span aria-hidden=\"true\">{}</span> {}</li>", shapes[k % 4], escape(markers[k]));
  return html;
}

std::string figure(const SvgPanel& panel, const std::string& said) {
  const std::string picture = svg(panel);
  return fmt::format("<figure><figcaption><b>{}</b>{}</figcaption>\n{}</figure>\n", escape(panel.title),
                     said.empty() ? "" : fmt::format("<span class=\"said\">{}</span>", escape(said)),
                     picture.empty() ? "<p>Every value is zero or missing: there is no curve to draw.</p>\n" : picture);
}

std::string alt_of(const SvgPanel& panel, const std::string& title) {
  std::vector<std::string> names;
  for (const SvgCurve& curve : panel.curves)
    if (!curve.name.empty() && std::ranges::find(names, curve.name) == names.end()) names.push_back(curve.name);
  return fmt::format("{}, {}: {} over {}. Curves: {}. The numbers are in the table that is linked.", title, panel.title,
                     panel.y, panel.x, fmt::join(names, ", "));
}

// A command that computes a case; the scene's file is called as the chart is.
std::string command(const ChartRow& row, const std::string& scene, const std::string& end) {
  const IntegratorEntry* entry = integrators().find(row.integrator);
  const std::string how = entry && entry->analysis == Analysis::kinematics
                              ? "--analysis kinematics"
                              : fmt::format("--integrator {}", row.integrator);
  return fmt::format("poinsot run {}.json --end {} --formulation {} {} --{} {}", scene, end, row.formulation, how,
                     row.parameter, row.value);
}

bool names_method(const std::string& said, const std::string& method) {
  for (std::size_t at = said.find(method); at != std::string::npos; at = said.find(method, at + 1)) {
    const std::string after = said.substr(at + method.size());
    const bool begins = at == 0 || !(std::isalnum(static_cast<unsigned char>(said[at - 1])) || said[at - 1] == '_');
    if (begins && !after.starts_with(" with") && (after.empty() || !std::isalnum(static_cast<unsigned char>(after[0]))))
      return true;
  }
  return false;
}

}  // namespace

std::string panels_html(const CsvTable& points, const std::string& title) {
  const int panel = points.column("panel"), series = points.column("series"), variant = points.column("variant"),
            x = points.column("x"), y = points.column("y"), low = points.column("low"), high = points.column("high");
  if (std::min({panel, series, variant, x, y, low, high}) < 0) return {};
  std::vector<std::string> order, colours, markers;
  std::map<std::string, SvgPanel> panels;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> curves;
  for (const auto& row : points.rows) {
    const auto field = [&](int column) -> const std::string& { return row[static_cast<std::size_t>(column)]; };
    const bool guide = field(variant) == kGuide;
    place(order, field(panel));
    SvgPanel& own = panels[field(panel)];
    const auto [at, fresh] = curves.try_emplace({field(panel), field(series), field(variant)}, own.curves.size());
    if (fresh) {
      own.curves.push_back({.name = field(series),
                            .colour = guide ? kGrey : place(colours, field(series)),
                            .marker = guide ? kLine : place(markers, field(variant)),
                            .dashed = guide});
    }
    SvgCurve& curve = own.curves[at->second];
    const std::string name = field(variant).empty() || field(variant) == field(series)
                                 ? field(series)
                                 : fmt::format("{}, {}", field(series), field(variant));
    curve.points.push_back(
        {csv_number(field(x)), csv_number(field(y)), guide ? "" : fmt::format("{}: {}, {}", name, field(x), field(y))});
    if (!field(low).empty()) {
      curve.low.push_back(csv_number(field(low)));
      curve.high.push_back(csv_number(field(high)));
    }
  }
  std::string html = "<div class=\"panels\">\n";
  const std::vector<int> of_series = colours_of(colours);
  for (const std::string& name : order) {
    SvgPanel& own = panels[name];
    for (SvgCurve& curve : own.curves) {
      if (curve.colour != kGrey) curve.colour = of_series[index(curve.colour)];
      if (points.note("joined") == "no")
        curve.joined = false;
      else if (curve.points.size() > kCourse)
        curve.marker = kLine;
    }
    own.title = name;
    own.x = points.note("x"), own.y = points.note("y");
    own.log_x = points.note("x scale") == "log", own.log_y = points.note("y scale") == "log";
    own.alt = alt_of(own, title);
    html += figure(own, "");
  }
  if (markers.size() == 1 || markers == colours) markers.clear();  // they tell nothing more
  return html + "</div>\n" + key_items(colours, markers) + "</ul>\n";
}

std::string chart_html(const CsvTable& chart) {
  const std::vector<ChartRow> rows = chart_rows(chart);
  const PerQuantity agreement = chart_agreement(rows);
  const std::string settings = chart.note("settings"), to = "to t = ";
  const std::string until =
      settings.starts_with(to) ? settings.substr(to.size(), settings.find(" s;") - to.size()) : "";
  std::vector<std::string> colours, markers = formulations().names();
  for (const ChartRow& row : rows)
    if (!row.is_reference()) place(colours, row.integrator);
  const std::vector<int> of_integrators = colours_of(colours);
  std::string html = "<div class=\"panels two\">\n";
  for (std::size_t quantity = 0; quantity < kQuantities.size(); ++quantity) {
    const CostCurves curves(rows, quantity, agreement[quantity]);
    if (curves.all().empty()) continue;
    const std::string said = chart.note(fmt::format("conclusion, {}", kQuantities[quantity]));
    SvgPanel panel;
    panel.title = fmt::format("Error in {}", kQuantities[quantity]);
    panel.x = fmt::format("error in {}", kQuantities[quantity]);
    panel.y = "time, s";
    panel.falling_x = true;
    if (curves.rounding_only()) {
      html += fmt::format("<figure><figcaption><b>{}</b><span class=\"said\">{}</span></figcaption></figure>\n",
                          escape(panel.title), escape(said));
      continue;
    }
    const std::vector<bool> front = curves.front();
    for (const CostCurve& curve : curves.all()) {
      const ChartRow& first = rows[curve.knots.front().row];
      const bool named = names_method(said, curve.method);
      SvgCurve drawn{.name = curve.method,
                     .colour = named ? of_integrators[index(place(colours, first.integrator))] : kGrey,
                     .marker = place(markers, first.formulation),
                     .labelled = named};
      for (std::size_t k = 0; k < rows.size(); ++k) {
        const Measured& m = rows[k].measured;
        if (!m.ok() || rows[k].method() != curve.method || !(m.error[quantity] <= 1)) continue;
        std::string tip = curve.method;
        if (named)
          tip += fmt::format(", {} {}: error {}, {} s\n{}", rows[k].parameter, rows[k].value, m.error[quantity],
                             m.seconds, command(rows[k], chart.file, until));
        drawn.points.push_back({m.error[quantity], m.seconds, std::move(tip), front[k]});
      }
      if (!drawn.points.empty()) panel.curves.push_back(std::move(drawn));
    }
    panel.alt = alt_of(panel, chart.file);
    html += figure(panel, said);
  }
  return html + "</div>\n" + key_items(colours, markers) +
         "<li>grey: methods that the sentence does not name; large points: on the front</li></ul>\n";
}

}  // namespace poinsot::report
