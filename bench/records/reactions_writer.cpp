#include "bench/records/reactions_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "core/index.h"
#include "core/reaction_components.h"

namespace poinsot::records {
namespace {

constexpr std::array<std::string_view, 1> kMultiplier{"lambda"};

std::span<const std::string_view> components_of(const Group& group) {
  if (group.kind == GroupKind::constraint) return kMultiplier;
  return kReactionComponents;
}

}  // namespace

ReactionsWriter::ReactionsWriter(const std::filesystem::path& file, const Model& model) : table_(file), columns_{"t"} {
  for (const Group& group : model.groups)
    for (const std::string_view component : components_of(group))
      columns_.push_back(fmt::format("{}.{}", group.name, component));
}

void ReactionsWriter::begin(const Model& model) {
  undetermined_ = reactions_->may_be_undetermined();
  for (const int of : undetermined_) {
    const Group& group = model.groups[index(of)];
    for (const std::string_view component : components_of(group))
      columns_.push_back(fmt::format("{}.{}.undetermined", group.name, component));
  }
  table_.begin(std::move(columns_));
}

void ReactionsWriter::write(const Sample& sample) {
  const Model& model = sample.problem.model();
  if (!reactions_) reactions_.emplace(sample.problem);
  reactions_->update(sample);
  if (!table_.begun()) begin(model);
  table_.write(sample.t);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (model.groups[g].kind == GroupKind::constraint) {
      table_.write(reactions_->lambda(model.groups[g].first_row));
      continue;
    }
    Vector3 force, moment;
    reactions_->of_group(static_cast<int>(g), force, moment);
    for (const Vector3* x : {&force, &moment})
      for (const double component : *x) table_.write(component);
  }
  if (!undetermined_.empty()) write_undetermined(model);
}

void ReactionsWriter::write_undetermined(const Model& model) {
  const std::vector<Undetermined> now = reactions_->undetermined();
  for (const int group : undetermined_) {
    const auto found = std::ranges::lower_bound(now, group, {}, &Undetermined::group);
    const bool any = found != now.end() && found->group == group;
    if (model.groups[index(group)].kind == GroupKind::constraint)
      table_.write(any ? 1 : 0);
    else
      for (std::size_t c = 0; c < kReactionComponents.size(); ++c) table_.write(any && found->loaded[c] ? 1 : 0);
  }
}

void ReactionsWriter::end() {
  if (!table_.begun()) table_.begin(std::move(columns_));
}

}  // namespace poinsot::records
