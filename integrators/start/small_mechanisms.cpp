#include "integrators/start/small_mechanisms.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/index.h"
#include "core/mechanisms.h"

namespace poinsot {
namespace {

struct Mechanism {
  std::vector<int> bodies, rows;
  double arm = 0;     // m, the longest of rows and springs on its bodies
  double way = 0;     // m, the longest of its springs and distances, and of what stretches them
  bool tied = false;  // by any
  double size() const { return std::max(arm, way); }
};

// How far it stretches by weight and by the speed its bodies start with, m.
double stretch(const Model& model, const Spring& spring) {
  double mass = 0, speed = 0;
  for (const int body : {spring.i, spring.j}) {
    if (body == kGround) continue;
    const Body& of = model.bodies[index(body)];
    mass = std::max(mass, of.mass), speed = std::max(speed, of.velocity.norm());
  }
  return spring.stiffness > 0
             ? model.gravity.norm() * mass / spring.stiffness + speed * std::sqrt(mass / spring.stiffness)
             : 0;
}

std::vector<Mechanism> parts(const Model& model) {
  const std::vector<int> number = mechanisms(model);
  std::vector<Mechanism> all(mechanism_count(number));
  for (std::size_t b = 0; b < number.size(); ++b) all[index(number[b])].bodies.push_back(static_cast<int>(b));
  const auto between = [&](const auto& pair, bool ties) -> Mechanism* {
    if (pair.i == kGround && pair.j == kGround) return nullptr;
    Mechanism& of = all[index(number[index(pair.i == kGround ? pair.j : pair.i)])];
    if (pair.i != kGround) of.arm = std::max(of.arm, pair.s_i.norm());
    if (pair.j != kGround) of.arm = std::max(of.arm, pair.s_j.norm());
    if (!ties) return &of;
    of.tied = true;
    of.way = std::max(of.way, (initial_point(model, pair.j, pair.s_j) - initial_point(model, pair.i, pair.s_i)).norm());
    return &of;
  };
  for (std::size_t k = 0; k < model.rows.size(); ++k)
    if (Mechanism* of = between(model.rows[k], model.rows[k].type == RowType::D))
      of->rows.push_back(static_cast<int>(k));
  for (const Spring& spring : model.springs)
    if (Mechanism* of = between(spring, !spring.law))
      of->way = std::max({of->way, spring.length, stretch(model, spring)});
  return all;
}

// How a row moves with the bodies' translations, j's positive.
Vector3 direction(const Model& model, const Row& row) {
  switch (row.type) {
    case RowType::CD:
      return row.c.normalized();
    case RowType::D:
      return (initial_point(model, row.j, row.s_j) - initial_point(model, row.i, row.s_i)).normalized();
    case RowType::DP2:
      return (initial_point(model, row.i, row.a_i) - initial_point(model, row.i, Vector3::Zero())).normalized();
    case RowType::pfaffian:
      return (initial_point(model, row.j, row.a_j) - initial_point(model, row.j, Vector3::Zero())).normalized();
    default:
      return Vector3::Zero();
  }
}

// Whether its bodies can move and none of them turn.
bool shifts(const Model& model, const Mechanism& of) {
  constexpr double kSingular = 1e-6;
  const Eigen::Index n = static_cast<Eigen::Index>(of.bodies.size());
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(of.rows.size()), 3 * n);
  const auto columns = [&](Eigen::Index row, int body) {
    const auto at = std::ranges::lower_bound(of.bodies, body) - of.bodies.begin();
    return G.row(row).segment<3>(3 * at);
  };
  for (Eigen::Index k = 0; k < G.rows(); ++k) {
    const Row& row = model.rows[index(of.rows[index(k)])];
    const Vector3 u = direction(model, row);
    if (row.i != kGround) columns(k, row.i) -= u.transpose();
    if (row.j != kGround) columns(k, row.j) += u.transpose();
  }
  if (G.rows() < G.cols()) return true;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(G);
  qr.setThreshold(kSingular);
  return qr.rank() < G.cols();
}

}  // namespace

void tell_small_mechanisms(const Model& model, double rtol, double atol,
                           const std::function<void(const std::string&)>& tell) {
  constexpr double kTold = 100;        // times rtol of the size: errors come to some hundred times rtol
  constexpr double kServes = 0.01;     // of it, as atol is by default of a metre
  constexpr double kNoLength = 1e-12;  // of the largest: rounding of what was to be none
  constexpr double kRounding = 1e-15;  // of the largest: what rests there is resolved in vain
  constexpr std::size_t kMost = 200;
  const std::vector<Mechanism> all = parts(model);
  double largest = 0;
  const Mechanism* least = nullptr;
  for (const Mechanism& of : all) largest = std::max(largest, of.size());
  for (const Mechanism& of : all) {
    if (!of.tied || !(of.size() > kNoLength * largest) || !(atol > kTold * rtol * of.size())) continue;
    if (of.bodies.size() > kMost || (least && least->size() <= of.size()) || !shifts(model, of)) continue;
    // So far from the origin the relative tolerance is the larger one.
    if (std::ranges::any_of(of.bodies, [&](int b) { return rtol * model.bodies[index(b)].position.norm() > atol; }))
      continue;
    least = &of;
  }
  if (!least) return;
  const double serves = kServes * rtol * least->size();
  const bool alone = serves < kRounding * largest;
  tell(fmt::format(
      "the mechanism of body '{}' measures {:.2g} m, and atol {:.2g} m is {:.2g} times rtol of that: errors of its "
      "positions may be as large as if rtol were so much larger; {}--atol {:.1g} serves it",
      model.bodies[index(least->bodies.front())].name, least->size(), atol, atol / (rtol * least->size()),
      alone ? "in a scene of its own " : "", serves));
}

}  // namespace poinsot
