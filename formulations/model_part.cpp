#include "formulations/model_part.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace poinsot {
namespace {

// The body's number in the part.
int add(Part& part, std::span<const BodyState> states, int body) {
  if (body == kGround) return kGround;
  part.model.bodies.emplace_back();
  part.states.push_back(states[static_cast<std::size_t>(body)]);
  return static_cast<int>(part.states.size()) - 1;
}

TermSize times(const TermSize& u, const TermSize& v) {
  return {u.value * v.value, u.rate * v.value + u.value * v.rate,
          u.second * v.value + 2 * u.rate * v.rate + u.value * v.second};
}

}  // namespace

Part part_of(const Model& model, std::span<const BodyState> states, const Group& group) {
  Part part;
  const int i = add(part, states, group.i), j = add(part, states, group.j);
  for (int k = 0; k < group.rows; ++k) {
    Row& row = part.model.rows.emplace_back(model.rows[static_cast<std::size_t>(group.first_row + k)]);
    row.i = i, row.j = j;
  }
  return part;
}
Part part_of(std::span<const BodyState> states, Spring spring) {
  Part part;
  spring.i = add(part, states, spring.i), spring.j = add(part, states, spring.j);
  part.model.springs.push_back(std::move(spring));
  return part;
}
Part part_of(std::span<const BodyState> states, TorsionElement torsion) {
  Part part;
  torsion.spring.i = add(part, states, torsion.spring.i), torsion.spring.j = add(part, states, torsion.spring.j);
  part.model.torsions.push_back(std::move(torsion));
  return part;
}
Part part_of(std::span<const BodyState> states, PointForce force) {
  Part part;
  force.body = add(part, states, force.body);
  part.model.point_forces.push_back(std::move(force));
  return part;
}
Part part_of(std::span<const BodyState> states, Torque torque) {
  Part part;
  torque.body = add(part, states, torque.body);
  part.model.torques.push_back(std::move(torque));
  return part;
}
Part part_of(std::span<const BodyState> states, LinearDrag drag) {
  Part part;
  drag.body = add(part, states, drag.body);
  part.model.drags.push_back(std::move(drag));
  return part;
}

Part part_of(std::span<const BodyState> states, CallbackForce force) {
  Part part;
  for (int& body : force.bodies) body = add(part, states, body);
  part.model.callbacks.push_back(std::move(force));
  return part;
}

TermSize term_size(const Part& part, const Row& row) {
  const auto state = [&](int body) {
    return body == kGround ? BodyState() : part.states[static_cast<std::size_t>(body)];
  };
  const auto attached = [&](int body, double s) {
    const double w = state(body).w.norm();
    return TermSize{s, s * w, s * w * w};
  };
  const TermSize p = attached(row.i, row.s_i.norm()), q = attached(row.j, row.s_j.norm());
  const TermSize span{state(row.i).r.norm() + state(row.j).r.norm() + p.value + q.value,
                      state(row.i).rd.norm() + state(row.j).rd.norm() + p.rate + q.rate, p.second + q.second};
  double a_i = row.a_i.norm(), a_j = row.a_j.norm();
  if (row.alternate) {
    a_i = std::max(a_i, row.alternate->a_i.norm());
    a_j = std::max(a_j, row.alternate->a_j.norm());
  }
  const Jet2<double> f = row.f.at(0.0);
  switch (row.type) {
    case RowType::DP1:
      return times(attached(row.i, a_i), attached(row.j, a_j));
    case RowType::DP2:
      return times(attached(row.i, a_i), span);
    case RowType::D:
      return times(span, span);
    case RowType::CD:
      return times({row.c.norm(), 0, 0}, span);
    case RowType::angle: {
      const TermSize a = attached(row.i, a_i);
      const double fd = std::abs(f.fd);
      return times({a.value, a.rate + a.value * fd, a.second + 2 * a.rate * fd + a.value * (fd * fd + std::abs(f.fdd))},
                   attached(row.j, a_j));
    }
    case RowType::pfaffian: {  // a velocity: one derivative higher
      const TermSize a = attached(row.j, a_j);
      const double coefficient = a.value * std::max(span.value, 1.0);
      return {std::max(coefficient, a.rate * span.value + a.value * span.rate), a.value * span.rate,
              a.rate * span.rate + a.value * span.second};
    }
  }
  return {0, 0, 0};
}

}  // namespace poinsot
