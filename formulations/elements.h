// What a model costs: attached vectors, constraint rows by kind, and coupled pairs of bodies, as flat tables.
//
// Each attached vector (a body and a constant vector in its frame) stands in the tables once, however many rows use it,
// and is evaluated once per configuration. Rows of one kind lie together. The tables do not depend on the formulation,
// are built once and never change.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/model.h"

namespace poinsot {

struct Marker {
  int body = kGround;
  Vector3 s_bar = Vector3::Zero();
};

// Two free bodies that a row couples in the second variation: x–x always, r–r, r–x and x–r where it says so.
struct Pair {
  int i, j;
  bool rr = false, rx = false, xr = false;  // rx: (r_i, x_j) and its mirror; xr: (x_i, r_j) and its mirror
  int with_r = -1;                          // place among the pairs with one of these, −1 without
};

// What a body's kinetics need.
struct Inertia {
  double mass;
  Matrix3 J;
};

// Right-hand side f(t), or f(t)², of a row. Constant ones are evaluated here and never again.
struct RightSide {
  Expression f;
  bool squared = false;
};

// u, v, p_i, q_j, a: indices of attached vectors. row: index of the multiplier. f: index of the right-hand side.
// pair: index of the coupled pair, or −1 when a body is grounded.
struct RowBase {
  int row, i, j, f, pair;
};
struct DP1Row : RowBase {
  int u, v;
};
struct DP2Row : RowBase {
  int a, p, q;
};
struct DRow : RowBase {
  int p, q;
};
struct CDRow : RowBase {
  Vector3 c;
  int p, q;
};
// Three CD rows in a row, along the x, y and z axis and with f = 0, that hold one point of body j at one of body i:
// what most joints have. Together they are d = 0, and their reaction is one force. `row` is the first.
struct CoincidenceRows : RowBase {
  int p, q;
};
struct AngleRow : RowBase {
  int a, b, v;
};
struct PfaffianRow : RowBase {
  int a, p, q;
};
// While |f| of the DP1 row at `primary` exceeds 0.9 this one stands in.
struct AlternateRow {
  int primary;  // index into dp1
  DP1Row normal, alternate;
};

// Tension or torque of a spring: stiffness x + damping v, or law(x, v, t) (formulations/spring_law.h).
struct ElementLaw {
  double stiffness, damping;
  bool damped;            // it depends on v
  const Expression* law;  // of the model; null of a linear spring
};
struct SpringElement : ElementLaw {
  int i, j, p, q;
  double length;
};
struct TorsionSpringElement : ElementLaw {
  int i, j, a, b, c;
  double angle;
};
struct FollowedAngleElement {
  int a, b, c;
};
struct PointForceElement {
  int body, p;
  Expression force[3];
  Frame frame;
};
struct TorqueElement {
  int body;
  Expression torque[3];
  Frame frame;
};

struct Elements {
  // Rows listed in `dropped` (sorted, model numbering) are left out and the others move up.
  Elements(std::shared_ptr<const Model> model, std::span<const int> dropped);

  std::shared_ptr<const Model> model;
  int nb = 0;
  int rows = 0;                // without normalization
  std::vector<int> model_row;  // model row of each row
  std::vector<int> row_of;     // row of each model row, −1 where dropped

  std::vector<Marker> markers;  // of free bodies first, of the ground from `ground_markers` on
  int ground_markers = 0;
  std::vector<RightSide> right_sides;  // index 0: the constant 0

  std::vector<DP1Row> dp1;
  std::vector<DP2Row> dp2;
  std::vector<DRow> d;
  std::vector<CDRow> cd;
  std::vector<CoincidenceRows> coincidences;
  std::vector<AngleRow> angle;
  std::vector<PfaffianRow> pfaffian;
  std::vector<AlternateRow> alternates;

  std::vector<Inertia> inertia;  // by body
  std::vector<Pair> pairs;
  int pairs_with_r = 0;
  // Body blocks that rows fill beside the inertia: (r, r), (r, x) and its mirror.
  std::vector<char> body_rr, body_rx;
  std::vector<int> body_own;  // place among the bodies with such blocks, −1 without
  int bodies_own = 0;
  // Node of each row for linear solvers: rows between the same two bodies belong together.
  std::vector<int> row_node;
  int row_nodes = 0;

  std::vector<SpringElement> springs;
  std::vector<TorsionSpringElement> torsions;
  std::vector<PointForceElement> point_forces;
  std::vector<TorqueElement> torques;
  std::vector<LinearDrag> drags;
  std::vector<FollowedAngleElement> followed;
  bool has_forces() const {
    return !(springs.empty() && torsions.empty() && point_forces.empty() && torques.empty() && drags.empty() &&
             model->callbacks.empty());
  }

 private:
  struct Builder;
};

}  // namespace poinsot
