#include "integrators/start/small_coefficients.h"

#include "core/index.h"
#include "integrators/start/small_cholesky.h"

namespace poinsot {

SmallCoefficients::SmallCoefficients(const Model& model, const RowSpace& space, const BlockRows& rows)
    : variables_(6 * static_cast<Eigen::Index>(rows.bodies())), beside_(rows.size()) {
  const int n = static_cast<int>(rows.size());
  const auto row = [&](int k) -> const Row& { return model.rows[index(space.rows()[index(rows.place_in_space(k))])]; };
  const auto share = [](const Row& a, const Row& b) {
    const auto acts_on = [&](int body) { return body != kGround && (body == b.i || body == b.j); };
    return acts_on(a.i) || acts_on(a.j);
  };
  for (int k = 0; k < n; ++k)
    for (int l = 0; l < n; ++l)
      if (share(row(k), row(l))) beside_[index(k)].push_back(l);
}

// The parts of a unit row on its bodies.
void SmallCoefficients::take_parts(const RowSpace& space, const BlockRows& rows) {
  parts_.resize(rows.size());
  for (int k = 0; k < static_cast<int>(parts_.size()); ++k) {
    Parts& of = parts_[index(k)];
    of.body[0] = of.body[1] = -1;
    int at = -1, last = -1;
    for (Eigen::SparseMatrix<double>::InnerIterator it(space.columns(), rows.place_in_space(k)); it; ++it) {
      const int body = static_cast<int>(it.row()) / 6;
      if (body != last) {
        of.body[++at] = rows.place_of_body(body);
        of.part[at].setZero();
        last = body;
      }
      of.part[at][it.row() % 6] = it.value();
    }
  }
}

double SmallCoefficients::dot(int k, int l) const {
  const Parts &a = parts_[index(k)], &b = parts_[index(l)];
  double sum = 0;
  for (int i = 0; i < 2 && a.body[i] >= 0; ++i)
    for (int j = 0; j < 2; ++j)
      if (a.body[i] == b.body[j]) sum += a.part[i].dot(b.part[j]);
  return sum;
}

bool SmallCoefficients::find(const RowSpace& space, const BlockRows& rows, const std::vector<int>& kept,
                             const std::vector<int>& left_out, Eigen::MatrixXd& C) {
  const auto n = static_cast<Eigen::Index>(kept.size()), m = static_cast<Eigen::Index>(left_out.size());
  take_parts(space, rows);
  place_.assign(parts_.size(), -1);
  for (Eigen::Index j = 0; j < n; ++j) place_[index(kept[index(j)])] = static_cast<int>(j);
  gram_.resize(n, n), C.setZero(n, m);
  const auto fill = [&](int k, Eigen::Index from, auto&& column) {
    for (const int l : beside_[index(k)]) {
      const int place = place_[index(l)];
      if (place >= from) column[place] = dot(k, l);
    }
  };
  for (Eigen::Index j = 0; j < n; ++j) {
    gram_.col(j).tail(n - j).setZero();
    fill(kept[index(j)], j, gram_.col(j));
  }
  for (Eigen::Index d = 0; d < m; ++d) fill(left_out[index(d)], 0, C.col(d));
  if (!small_cholesky(gram_)) return false;
  small_cholesky_solve(gram_, C);
  return C.allFinite();
}

void SmallCoefficients::refine(const std::vector<int>& kept, const std::vector<int>& left_out,
                               Eigen::MatrixXd& C) const {
  Eigen::MatrixXd change(C.rows(), C.cols());
  Eigen::VectorXd left(variables_);
  const auto add = [&](double factor, int k) {
    const Parts& of = parts_[index(k)];
    for (int i = 0; i < 2 && of.body[i] >= 0; ++i) left.segment<6>(6 * of.body[i]) += factor * of.part[i];
  };
  for (Eigen::Index d = 0; d < C.cols(); ++d) {
    left.setZero();
    add(1, left_out[index(d)]);
    for (Eigen::Index k = 0; k < C.rows(); ++k) add(-C(k, d), kept[index(k)]);
    for (Eigen::Index k = 0; k < C.rows(); ++k) {
      const Parts& of = parts_[index(kept[index(k)])];
      change(k, d) = 0;
      for (int i = 0; i < 2 && of.body[i] >= 0; ++i) change(k, d) += of.part[i].dot(left.segment<6>(6 * of.body[i]));
    }
  }
  small_cholesky_solve(gram_, change);
  C += change;
}

}  // namespace poinsot
