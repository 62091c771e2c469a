#include "bench/records/reactions_writer.h"

namespace poinsot::records {
using namespace study;

ReactionsWriter::ReactionsWriter(const std::filesystem::path& file, const Model& model) : file_(file) {
  file_.write("t");
  for (const Group& group : model.groups) {
    if (group.kind == GroupKind::constraint)
      file_.write_field(group.name + ".lambda");
    else
      for (const char* column : {".fx", ".fy", ".fz", ".nx", ".ny", ".nz"}) file_.write_field(group.name + column);
    columns_ += group.kind == GroupKind::constraint ? 1 : 6;
  }
  file_.write("\n");
}

void ReactionsWriter::write(const Sample& sample) {
  const std::vector<Group>& groups = sample.problem.model().groups;
  if (!reactions_) reactions_.emplace(sample.problem);
  reactions_->update(sample);
  file_.write(sample.t);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].kind == GroupKind::constraint) {
      file_.write(",");
      file_.write(reactions_->lambda(groups[g].first_row));
      continue;
    }
    Vector3 force, moment;
    reactions_->of_group(static_cast<int>(g), force, moment);
    for (const Vector3* x : {&force, &moment})
      for (const double component : *x) {
        file_.write(",");
        file_.write(component);
      }
  }
  file_.write("\n");
}

}  // namespace poinsot::records
