#include "bench/stability/suite.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/cases/executor.h"
#include "bench/study/cache.h"
#include "bench/study/csv.h"
#include "formulations/registry.h"
#include "integrators/settings_reader.h"

namespace poinsot::stability {
namespace {

bool listed(const std::vector<std::string>& names, std::string_view name) {
  return names.empty() || std::ranges::find(names, name) != names.end();
}

// How many places an axis has for this integrator.
std::size_t places(const Axis& axis, bool quick, bool controls_error) {
  return axis.of_settings() ? axis.of(quick, controls_error).size() : 1;
}

struct Length {
  double end, steps;
};

// What an axis of settings says at a place of it.
void apply(const Axis& axis, bool quick, std::size_t place, bool controls_error, Settings& settings, Length& length) {
  if (!axis.of_settings()) return;
  const double value = axis.of(quick, controls_error)[place];
  if (axis.along == Axis::accuracy) (controls_error ? settings.rtol : length.steps) = value;
  if (axis.along == Axis::step) length.end = value * length.steps;
  if (axis.along == Axis::length) {
    length.end *= value;
    length.steps *= value;
  }
}

}  // namespace

FamilyStudy::FamilyStudy(const Family& family, const Extent& extent) : family_(family), quick_(extent.quick) {
  study_.name = family.name;
  add_columns();
  add_scenes();
  add_axes();
  add_settings(extent);
}

void FamilyStudy::add_columns() {
  const bool same_end = family_.x.along != Axis::step && family_.x.along != Axis::length &&
                        family_.y.along != Axis::step && family_.y.along != Axis::length;
  for (const std::string_view column : family_.columns) {
    cases::Quantity& quantity = study_.kept.quantities.emplace_back();
    quantity.name = quantity.column = column;
    if (same_end)
      for (const int quarter : {1, 2, 3, 4}) quantity.at.push_back(family_.end * quarter / 4);
    else
      quantity.final = true;
  }
  study_.kept.counts = study_.kept.notices = true;
  study_.columns_hash = study::content_hash(study_.kept.text() + (same_end ? " at quarters" : " at the end"));
}

void FamilyStudy::add_scenes() {
  for (const std::string_view text : family_.scenes) {
    cases::StudyScene one;
    one.name = fmt::format("{}{}", family_.name,
                           family_.scenes.size() > 1 ? fmt::format(" {}", study_.scenes.size() + 1) : "");
    one.scene = parse_scene(text, one.name);
    one.hash = study::content_hash(one.scene.source);
    const Model model = compile(one.scene);
    for (const cases::Quantity& quantity : study_.kept.quantities)
      one.columns.push_back(*cases::find_column(model, quantity.column));
    study_.scenes.push_back(std::move(one));
  }
}

void FamilyStudy::add_axes() {
  for (const Axis* axis : {&family_.y, &family_.x}) {
    if (axis->along != Axis::parameter) continue;
    cases::ParameterAxis& added = study_.axes.emplace_back();
    added.names = {std::string(axis->name)};
    added.values = axis->of(quick_);
  }
}

void FamilyStudy::add_settings(const Extent& extent) {
  study_.settings_varied = {"formulation", "integrator", "step", "rtol", "end"};
  for (const FormulationEntry& formulation : formulations()) {
    for (const IntegratorEntry& integrator : integrators()) {
      if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, formulation.name) ||
          !listed(extent.formulations, formulation.name) || !listed(extent.integrators, integrator.name))
        continue;
      const bool controls = integrator.controls_error;
      for (std::size_t y = 0; y < places(family_.y, quick_, controls); ++y) {
        for (std::size_t x = 0; x < places(family_.x, quick_, controls); ++x) {
          cases::SettingsChoice choice;
          Settings& s = choice.settings;
          s.formulation = formulation.name;
          s.integrator = integrator.name;
          s.rtol = family_.rtol;
          Length length{family_.end, family_.steps};
          apply(family_.y, quick_, y, controls, s, length);
          apply(family_.x, quick_, x, controls, s, length);
          s.end = length.end;
          s.step = length.end / length.steps;
          s.every = study_.kept.quantities.front().final ? s.end : s.end / 4;
          for (const cases::StudyScene& one : study_.scenes)
            for (const cases::Column& column : one.columns) s.reactions |= column.of == cases::Column::reaction;
          choice.values = {s.formulation, s.integrator, fmt::format("{}", s.step), fmt::format("{}", s.rtol),
                           fmt::format("{}", s.end)};
          choice.hash = study::content_hash(to_json(s));
          study_.settings.push_back(std::move(choice));
          choices_.push_back({&integrator, x, y});
        }
      }
    }
  }
}

Cell FamilyStudy::cell(const cases::CaseTable& table, std::int64_t number) const {
  const cases::Case one = cases::case_of(study_, number);
  const Choice& choice = choices_[one.settings];
  const Settings& settings = study_.settings[one.settings].settings;
  Cell cell;
  cell.formulation = settings.formulation;
  cell.integrator = settings.integrator;
  cell.step = settings.step;
  cell.end = settings.end;
  cell.rtol = settings.rtol;
  cell.bodies = study_.scenes[one.scene].scene.bodies.size();
  std::size_t parameter = 0;
  const auto place = [&](const Axis& axis, std::size_t of_choice, double& value, std::size_t& at) {
    if (axis.along == Axis::parameter) {
      value = one.parameters[parameter++];
      at = static_cast<std::size_t>(std::ranges::find(axis.of(quick_), value) - axis.of(quick_).begin());
    } else if (axis.along == Axis::variant) {
      at = one.scene;
      value = static_cast<double>(at);
    } else {
      at = of_choice;
      value = axis.along == Axis::accuracy ? choice.integrator->controls_error ? settings.rtol : settings.step
                                           : axis.of(quick_)[at];
    }
  };
  place(family_.y, choice.y_place, cell.y, cell.y_place);
  place(family_.x, choice.x_place, cell.x, cell.x_place);
  const std::vector<std::string> header = study::csv_fields(cases::header(study_));
  const std::vector<std::string> fields = study::csv_fields(table.fields(number));
  const auto field = [&](std::string_view column) -> const std::string& {
    return fields[static_cast<std::size_t>(std::ranges::find(header, column) - header.begin())];
  };
  cell.status = field("status");
  cell.message = field("message");
  cell.steps = study::csv_number(field("steps"));
  for (const cases::Quantity& quantity : study_.kept.quantities) {
    if (quantity.final) cell.values.push_back(study::csv_number(field(quantity.name + ".final")));
    for (const double t : quantity.at)
      cell.values.push_back(study::csv_number(field(cases::Kept::at_name(quantity.name, t))));
  }
  return cell;
}

std::vector<Cell> FamilyStudy::cells(const cases::CaseTable& table) const {
  std::vector<Cell> all;
  for (std::int64_t number = 0; number < study_.size(); ++number) all.push_back(cell(table, number));
  judge(family_, all);
  const auto place_in = [](const auto& registry, const std::string& name) {
    return std::ranges::find(registry, name, [](const auto& e) { return e.name; }) - registry.begin();
  };
  std::ranges::stable_sort(all, {}, [&](const Cell& c) {
    return std::tuple(place_in(integrators(), c.integrator), place_in(formulations(), c.formulation), c.y_place,
                      c.x_place);
  });
  return all;
}

void compute(const FamilyStudy& family, cases::CaseTable& table, int threads, const std::function<void()>& meanwhile) {
  const cases::Selection all(family.study(), false);
  cases::References none{study::Cache("")};
  cases::Undone undone(all, table);
  cases::run_threads(family.study(), none, threads,
                     {[&] { return undone.take(1); }, [&](cases::CaseRow&& row) { table.add(row); }, meanwhile});
}

}  // namespace poinsot::stability
