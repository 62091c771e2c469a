#include "integrators/start/loop_rows.h"

#include <Eigen/QR>
#include <cmath>

#include "core/index.h"
#include "linsolve/lists.h"

namespace poinsot {
namespace {

constexpr double kClearly = 1e-2;  // what of a unit row has to be left beside the others on a body that is taken off

}  // namespace

RowSpace all_rows(const std::shared_ptr<const Model>& model, double t, std::span<const BodyState> states) {
  RowSpace space(model, all_but(model->rows.size(), {}));
  space.stand(t, states);
  return space;
}

std::vector<int> loop_rows(const std::shared_ptr<const Model>& model, double t, std::span<const BodyState> states) {
  return loop_rows(*model, all_rows(model, t, states));
}

std::vector<int> loop_rows(const Model& model, const RowSpace& space) {
  const std::vector<int>& rows = space.rows();
  const int bodies = static_cast<int>(model.bodies.size());
  const auto row = [&](int k) -> const Row& { return model.rows[index(rows[index(k)])]; };
  const Lists rows_on = Lists::collect(bodies, [&](auto&& emit) {
    for (int k = 0; k < static_cast<int>(rows.size()); ++k)
      for (const int body : {row(k).i, row(k).j})
        if (body != kGround) emit(body, k);
  });
  std::vector<char> row_left(rows.size(), 1), body_left(index(bodies), 1);

  const auto independent = [&](int body, const std::vector<int>& own) {
    if (own.size() > 6) return false;
    Eigen::MatrixXd part = Eigen::MatrixXd::Zero(6, static_cast<Eigen::Index>(own.size()));
    for (std::size_t c = 0; c < own.size(); ++c)
      for (Eigen::SparseMatrix<double>::InnerIterator it(space.columns(), own[c]); it; ++it)
        if (it.row() / 6 == body) part(it.row() % 6, static_cast<Eigen::Index>(c)) = it.value();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(part);
    return std::abs(qr.matrixQR().diagonal()[part.cols() - 1]) > kClearly;
  };

  std::vector<int> due(index(bodies));
  for (int b = 0; b < bodies; ++b) due[index(b)] = bodies - 1 - b;
  std::vector<int> own;
  while (!due.empty()) {
    const int body = due.back();
    due.pop_back();
    if (!body_left[index(body)]) continue;
    own.clear();
    int neighbour = body;  // none yet
    bool one = true;
    for (const int k : rows_on[body]) {
      if (!row_left[index(k)]) continue;
      own.push_back(k);
      const int other = row(k).i == body ? row(k).j : row(k).i;
      one = one && (neighbour == body || other == neighbour);
      neighbour = other;
    }
    if (!one || (!own.empty() && !independent(body, own))) continue;
    body_left[index(body)] = 0;
    for (const int k : own) row_left[index(k)] = 0;
    if (neighbour != body && neighbour != kGround) due.push_back(neighbour);
  }
  std::vector<int> left;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (row_left[k]) left.push_back(rows[k]);
  return left;
}

}  // namespace poinsot
