#include "integrators/start/grounded_rows.h"

#include <Eigen/LU>
#include <array>
#include <map>

#include "core/index.h"

namespace poinsot {
namespace {

constexpr double kInSpace = 1e-6;  // of |c₁·(c₂ × c₃)|², unit vectors: from here on three directions span all

bool between_bodies(const Row& row) {
  return row.i != kGround && row.j != kGround && (row.type == RowType::CD || row.type == RowType::pfaffian);
}

// Points of two bodies that CD rows of the whole model keep in one place; those set aside hold as well.
class Coincidences {
 public:
  explicit Coincidences(const Model& model) {
    for (const Row& row : model.rows) {
      if (row.type != RowType::CD || !between_bodies(row) || !row.f.is_constant() || row.f.at(0.0).f != 0) continue;
      const Vector3 c = row.c.normalized();
      directions_.try_emplace(key(row), Matrix3::Zero()).first->second += c * c.transpose();
    }
  }

  bool hold(const Row& row) const {
    const auto found = directions_.find(key(row));
    return found != directions_.end() && found->second.determinant() > kInSpace;
  }

 private:
  using Key = std::array<double, 8>;
  static Key key(const Row& row) {
    return {static_cast<double>(row.i), row.s_i[0], row.s_i[1], row.s_i[2],
            static_cast<double>(row.j), row.s_j[0], row.s_j[1], row.s_j[2]};
  }
  std::map<Key, Matrix3> directions_;  // Σ c cᵀ
};

}  // namespace

std::vector<int> grounded_rows(const Model& model, std::span<const int> rows) {
  std::vector<int> found;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = model.rows[index(rows[k])];
    const bool of_joint = model.groups[index(row.group)].kind == GroupKind::joint;  // whose points coincide
    if (!of_joint && between_bodies(row)) found.push_back(static_cast<int>(k));
  }
  if (found.empty()) return found;
  const Coincidences coincidences(model);
  std::erase_if(found, [&](int k) { return coincidences.hold(model.rows[index(rows[index(k)])]); });
  return found;
}

}  // namespace poinsot
