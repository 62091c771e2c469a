#include "bench/cases/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "bench/view/trajectory_columns.h"
#include "core/input_error.h"
#include "core/printable.h"
#include "core/reaction_components.h"
#include "core/so3.h"

namespace poinsot::cases {
namespace {

double of_body(const BodyState& b, std::size_t component) {
  constexpr std::size_t kPosition = 3, kParameters = 4;
  if (component >= kPosition && component < kPosition + kParameters)
    return parameters_from_rotation<double>(b.A)(static_cast<Eigen::Index>(component - kPosition));
  const Vector3* const vectors[] = {&b.r, &b.rd, &b.w, &b.rdd, &b.wd};
  if (component > kPosition) component -= kParameters;
  return (*vectors[component / 3])(static_cast<Eigen::Index>(component % 3));
}

}  // namespace

std::optional<Column> find_column(const Model& model, const std::string& name) {
  std::vector<Column> found;
  const auto match = [&](const std::string& owner, std::string_view column) {
    return name.size() == owner.size() + 1 + column.size() && name.starts_with(owner) && name[owner.size()] == '.' &&
           name.ends_with(column);
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (std::size_t k = 0; k < view::kTrajectoryColumns.size(); ++k)
      if (match(model.bodies[b].name, view::kTrajectoryColumns[k])) found.push_back({Column::body, b, k});
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (model.groups[g].kind == GroupKind::constraint) {
      if (match(model.groups[g].name, "lambda")) found.push_back({Column::reaction, g, 0});
      continue;
    }
    for (std::size_t k = 0; k < kReactionComponents.size(); ++k)
      if (match(model.groups[g].name, kReactionComponents[k])) found.push_back({Column::reaction, g, k});
  }
  const std::vector<std::string> signals = Signals::names(model);
  if (const auto at = std::ranges::find(signals, name); at != signals.end())
    found.push_back({Column::signal, static_cast<std::size_t>(at - signals.begin()), 0});
  if (found.empty()) return {};
  if (found.size() > 1)
    throw InputError(fmt::format(
        "column '{}' stands in several files of a run (trajectory, reactions, signals); expected the body, or the "
        "joint, driver or spring, to have a name of its own",
        printable(name)));
  return found.front();
}

SampleColumns::SampleColumns(const std::vector<Column>& columns) {
  for (const Column& column : columns)
    (column.of == Column::body ? with_bodies_ : column.of == Column::reaction ? with_reactions_ : with_signals_) = true;
}

void SampleColumns::update(const Sample& sample) {
  model_ = &sample.problem.model();
  if (with_bodies_) {
    bodies_.resize(static_cast<std::size_t>(sample.problem.bodies()));
    sample.problem.to_bodies(sample.a, bodies_);
  }
  if (with_reactions_) {
    if (!reactions_) reactions_.emplace(sample.problem);
    reactions_->update(sample);
  }
  if (with_signals_) {
    if (!signals_) signals_.emplace(sample.problem);
    signals_->update(sample);
  }
}

double SampleColumns::value(const Column& column) const {
  if (column.of == Column::body) return of_body(bodies_[column.item], column.component);
  if (column.of == Column::signal) return signals_->values()[column.item];
  const Group& group = model_->groups[column.item];
  if (group.kind == GroupKind::constraint) return reactions_->lambda(group.first_row);
  Vector3 force, moment;
  reactions_->of_group(static_cast<int>(column.item), force, moment);
  return column.component < 3 ? force(static_cast<Eigen::Index>(column.component))
                              : moment(static_cast<Eigen::Index>(column.component - 3));
}

}  // namespace poinsot::cases
