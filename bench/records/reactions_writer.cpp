#include "bench/records/reactions_writer.h"

#include <fmt/format.h>

#include "core/reaction_components.h"

namespace poinsot::records {
namespace {

std::vector<std::string> columns_of(const Model& model) {
  std::vector<std::string> names{"t"};
  for (const Group& group : model.groups) {
    if (group.kind == GroupKind::constraint)
      names.push_back(group.name + ".lambda");
    else
      for (const std::string_view column : kReactionComponents)
        names.push_back(fmt::format("{}.{}", group.name, column));
  }
  return names;
}

}  // namespace

ReactionsWriter::ReactionsWriter(const std::filesystem::path& file, const Model& model)
    : table_(file, columns_of(model)) {}

void ReactionsWriter::write(const Sample& sample) {
  const std::vector<Group>& groups = sample.problem.model().groups;
  if (!reactions_) reactions_.emplace(sample.problem);
  reactions_->update(sample);
  table_.write(sample.t);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].kind == GroupKind::constraint) {
      table_.write(reactions_->lambda(groups[g].first_row));
      continue;
    }
    Vector3 force, moment;
    reactions_->of_group(static_cast<int>(g), force, moment);
    for (const Vector3* x : {&force, &moment})
      for (const double component : *x) table_.write(component);
  }
}

}  // namespace poinsot::records
