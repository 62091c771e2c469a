#include "linsolve/column_dependencies.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "linsolve/front_qr.h"
#include "linsolve/separation.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr int kWide = 300;            // entries of a row that fronts do without
constexpr double kNegligible = 1e-9;  // of a sum beside the largest entry of its vector
constexpr double kMentioned = 1e-6;   // of a coefficient beside that of the dependent column
constexpr double kGrown = 1e6;        // times: rounding of 1e-12, as projections leave it, is 1e-6 of a column then
// Times the square of the number of columns: loads along a mechanism grow with the square of its length.
constexpr double kExploded = 0.01;
constexpr double kMostWork = 2e9;  // operations with what wide rows leave of columns

// A z at the wide rows, as entries behind those of the columns: combined like them, and zero for a null vector of A.
// `from` grows to the largest that passes for zero, beside the largest of z.
void append_wide_rows(const Sparse& A, const std::vector<int>& wide, double tolerance, SparseEntries& z, double& from) {
  std::map<int, double> sums;
  for (const auto& [column, value] : z)
    for (Sparse::InnerIterator it(A, column); it; ++it)
      if (const int k = wide[static_cast<std::size_t>(it.row())]; k >= 0) sums[k] += it.value() * value;
  const double size = largest(z), nothing = std::max(tolerance, kNegligible) * size;
  for (const auto& [k, sum] : sums)
    if (std::abs(sum) > nothing)
      z.emplace_back(static_cast<int>(A.cols()) + k, sum);
    else
      from = std::max(from, std::abs(sum) / size);
}

// Of the columns that depend on others but for the wide rows, those that do with them: as many are independent by wide
// rows as these have independent sums. In time with the number of columns. `from` grows to the largest part of one that
// passes for nothing.
std::vector<int> dependent_on_wide_rows(const Sparse& A, const std::vector<int>& wide, int count, FrontQr& qr,
                                        double tolerance, double& from) {
  const std::vector<int>& columns = qr.dependent();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, A.cols());
  for (int k = 0; k < A.outerSize(); ++k)
    for (Sparse::InnerIterator it(A, k); it; ++it)
      if (const int row = wide[static_cast<std::size_t>(it.row())]; row >= 0) rows(row, k) = it.value();
  auto [sums, sizes] = qr.times_null_vectors(rows);
  std::vector<char> is_dependent(columns.size(), 1);
  for (int row = 0; row < count; ++row) {
    const Eigen::RowVectorXd parts = sums.cwiseAbs().colwise().maxCoeff().cwiseQuotient(sizes.transpose().cwiseMax(1));
    Eigen::Index pivot = 0, at = 0;
    const double most = parts.maxCoeff(&pivot);
    if (!(most > std::max(tolerance, kNegligible))) {
      from = std::max(from, most);
      break;
    }
    sums.col(pivot).cwiseAbs().maxCoeff(&at);
    is_dependent[static_cast<std::size_t>(pivot)] = 0;
    const Eigen::VectorXd column = sums.col(pivot) / sums(at, pivot);
    const Eigen::RowVectorXd by = sums.row(at);
    sums -= column * by;
  }
  std::vector<int> dependent;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (is_dependent[k]) dependent.push_back(columns[k]);
  std::ranges::sort(dependent);
  return dependent;
}

// Combines the vectors until each ends at an index of its own, which becomes its key.
std::map<int, SparseEntries> echelon(std::vector<SparseEntries> vectors) {
  std::map<int, std::vector<SparseEntries>> by_last;
  const auto sort_in = [&](SparseEntries&& z) {
    if (!z.empty()) by_last[z.back().first].push_back(std::move(z));
  };
  for (SparseEntries& z : vectors) sort_in(std::move(z));
  std::map<int, SparseEntries> ends;
  while (!by_last.empty()) {
    auto node = by_last.extract(std::prev(by_last.end()));
    const int last = node.key();
    std::vector<SparseEntries>& same = node.mapped();
    const auto share = [](const SparseEntries& z) { return std::abs(z.back().second) / largest(z); };
    std::iter_swap(same.begin(), std::ranges::max_element(same, {}, share));
    for (std::size_t k = 1; k < same.size(); ++k)
      sort_in(subtract(same[k], same[k].back().second / same[0].back().second, same[0], last));
    ends.emplace(last, std::move(same[0]));
  }
  return ends;
}

// Rows that fronts do without.
struct WideRows {
  int count = 0;
  std::vector<int> number;     // by row, −1 of others
  std::vector<char> left_out;  // by row

  explicit WideRows(const Sparse& A) : number(static_cast<std::size_t>(A.rows()), -1), left_out(number.size(), 0) {
    std::vector<int> entries(number.size(), 0);
    for (int k = 0; k < A.outerSize(); ++k)
      for (Sparse::InnerIterator it(A, k); it; ++it) ++entries[static_cast<std::size_t>(it.row())];
    for (std::size_t k = 0; k < entries.size(); ++k)
      if (entries[k] > kWide) number[k] = count++, left_out[k] = 1;
  }
};

struct Decomposed {
  FrontQr qr;
  double from;  // the least tolerance at which it is the same
};

// Where the columns kept by their order are barely independent, and rounding of A decides about what is left of others,
// those are kept that are clearest, or calmest where these are no better; unless `enough` of them are dependent all the
// same. So, too, beside wide rows: what these hold is found by sums along null vectors, which such columns make long.
Decomposed decomposed(const Sparse& A, const WideRows& wide, double tolerance, std::size_t most, std::size_t enough) {
  const auto choose = [&](FrontQr::Choice choice, std::size_t vectors) {
    FrontQr qr(A, wide.left_out, tolerance, choice, vectors);
    const double from = qr.left();
    return Decomposed{std::move(qr), from};
  };
  if (wide.count > 0) return choose(FrontQr::Choice::clearest, SIZE_MAX);
  Decomposed first = choose(FrontQr::Choice::by_order, most);
  if (first.qr.growth() <= kGrown || first.qr.dependent().size() >= enough) return first;
  const double natural = kExploded * std::pow(static_cast<double>(A.cols()), 2);
  for (const auto choice : {FrontQr::Choice::clearest, FrontQr::Choice::calmest}) {
    if (choice == FrontQr::Choice::calmest && first.qr.growth() <= std::max(kGrown, natural)) break;
    Decomposed other = choose(choice, most);
    first.from = other.from = std::max(first.from, other.from);
    if (other.qr.growth() < first.qr.growth()) first = std::move(other);
  }
  return first;
}

// Null vectors of A, by the last column of each.
struct Echelon {
  std::map<int, SparseEntries> by_last;
  std::vector<int> dependent;  // instead, where the vectors are not needed or would be too long
  bool complete = true;
  double from;  // the least tolerance that comes to the same
  std::size_t stretched;

  // Vectors are not needed where there are more than `most`.
  Echelon(const Sparse& A, double tolerance, const WideRows& wide_rows, Decomposed& of, std::size_t most)
      : from(of.from), stretched(of.qr.stretched()) {
    const int count = wide_rows.count;
    const std::vector<int>& wide = wide_rows.number;
    FrontQr& qr = of.qr;
    const double work = static_cast<double>(qr.dependent().size()) * count * count;
    if (count > 0 && qr.dependent().size() > most && work < kMostWork) {
      complete = false;
      dependent = dependent_on_wide_rows(A, wide, count, qr, tolerance, from);
      return;
    }
    std::vector<SparseEntries> vectors;
    std::size_t size = 0;
    for (const int column : qr.dependent()) {
      complete = count > 0 || (qr.dependent().size() <= most && size <= kMostNamed);
      if (!complete) break;
      SparseEntries& z = vectors.emplace_back(qr.null_vector(column));
      drop_nothing(z);
      append_wide_rows(A, wide, tolerance, z, from);
      size += z.size();
    }
    if (!complete) {
      dependent = qr.dependent();
      std::sort(dependent.begin(), dependent.end());
      return;
    }
    by_last = echelon(std::move(vectors));
    by_last.erase(by_last.lower_bound(static_cast<int>(A.cols())), by_last.end());  // a wide row holds these
    for (const auto& [column, z] : by_last) dependent.push_back(column);
  }
};

ColumnDependencies dependencies(Echelon space) {
  ColumnDependencies found;
  found.named = space.complete;
  for (const int column : space.dependent) found.columns.push_back({column, {}});
  std::size_t size = 0, k = 0;
  for (auto& [column, z] : space.by_last) {
    // Ascending: the dependent columns a vector contains have been expressed by independent ones before.
    if (size <= kMostNamed) {
      const SparseEntries contained = z;
      for (const auto& [index, value] : contained)
        if (const auto other = space.by_last.find(index); index != column && other != space.by_last.end())
          z = subtract(z, value / other->second.back().second, other->second, index);
    }
    size += z.size();
    for (const auto& [index, value] : z)
      if (index != column && std::abs(value) > kMentioned * std::abs(z.back().second))
        found.columns[k].others.push_back(index);
    ++k;
  }
  return found;
}

}  // namespace

ColumnDependencies column_dependencies(const Sparse& A, double tolerance) {
  const WideRows wide(A);
  Decomposed of = decomposed(A, wide, tolerance, kMostNamed, SIZE_MAX);
  return dependencies(Echelon(A, tolerance, wide, of, kMostNamed));
}

std::vector<int> clearest_dependent_columns(const Sparse& A, double tolerance) {
  const WideRows wide(A);
  if (wide.count > 0) return dependent_columns(A, tolerance);
  std::vector<int> columns = FrontQr(A, wide.left_out, tolerance, FrontQr::Choice::clearest, 0).dependent();
  std::ranges::sort(columns);
  return columns;
}

std::vector<int> dependent_columns(const Sparse& A, double tolerance, std::size_t enough) {
  const WideRows wide(A);
  Decomposed of = decomposed(A, wide, tolerance, 0, enough);
  return Echelon(A, tolerance, wide, of, 0).dependent;
}

NullSpace null_space(const Sparse& A, double tolerance, std::size_t most, const AlsoOfDecomposition& also) {
  const WideRows wide(A);
  Decomposed of = decomposed(A, wide, tolerance, also.keep ? SIZE_MAX : also.named ? kMostNamed : most, SIZE_MAX);
  if (also.named) *also.named = dependencies(Echelon(A, tolerance, wide, of, kMostNamed));
  Echelon space(A, tolerance, wide, of, most);
  NullSpace found{std::move(space.dependent), {}, space.from, space.stretched, nullptr};
  for (auto& [column, z] : space.by_last) found.vectors.push_back(std::move(z));
  if (also.keep && wide.count == 0) found.decomposition = std::make_shared<FrontQr>(std::move(of.qr));
  return found;
}

}  // namespace poinsot
