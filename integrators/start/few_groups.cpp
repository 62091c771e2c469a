#include "integrators/start/few_groups.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/index.h"
#include "integrators/start/block_choice.h"
#include "integrators/start/grouped_rows.h"
#include "integrators/start/row_blocks.h"
#include "linsolve/separation.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr std::size_t kMostChosen = BlockChoice::kMost;  // dependent rows: the time grows with their square

class Choice {
 public:
  Choice(const Model& model, std::span<const int> rows, const Sparse& columns)
      : model_(model), rows_(rows), columns_(columns), blocks_(row_blocks(model, rows)), turns_(opening_turns(model)) {}

  std::vector<int> at_once(std::vector<SparseEntries>&& vectors) const {
    return gather(std::move(vectors), grouped_rows(model_, turns_, rows_));
  }

  // `null`: as many are to be found as it has columns.
  std::vector<int> by_block(const NullSpace& null, double tolerance) const {
    std::vector<char> dependent(rows_.size(), 0);
    for (const int k : null.columns) dependent[index(k)] = 1;
    std::vector<int> of_all;
    for (int b = 0; b < blocks_.size(); ++b) {
      const std::span<const int> block = blocks_[b];
      std::vector<int> of_block;
      std::ranges::copy_if(block, std::back_inserter(of_block), [&](int k) { return dependent[index(k)] != 0; });
      if (!of_block.empty() && of_block.size() <= kMostChosen) {
        std::vector<SparseEntries> vectors =
            null.decomposition ? vectors_of(block, of_block, *null.decomposition) : vectors_of(block, tolerance);
        // Unless a block by itself shows another number of them than it does among all.
        if (vectors.size() == of_block.size()) of_block = chosen(block, std::move(vectors));
      }
      of_all.insert(of_all.end(), of_block.begin(), of_block.end());
    }
    return of_all;
  }

 private:
  std::vector<int> chosen(std::span<const int> block, std::vector<SparseEntries>&& vectors) const {
    std::vector<int> columns = gather(std::move(vectors), grouped_rows(model_, turns_, rows_of(block)));
    for (int& k : columns) k = block[index(k)];
    return columns;
  }

  // By place in the block. Fewer than there are `dependent` where one does not stay in it.
  static std::vector<SparseEntries> vectors_of(std::span<const int> block, const std::vector<int>& dependent,
                                               FrontQr& decomposition) {
    std::vector<SparseEntries> vectors;
    for (const int column : dependent) {
      SparseEntries& z = vectors.emplace_back(decomposition.null_vector(column));
      drop_nothing(z);
      for (auto& [k, value] : z) {
        const auto place = std::ranges::lower_bound(block, k);
        if (place == block.end() || *place != k) {
          vectors.pop_back();
          return vectors;
        }
        k = static_cast<int>(place - block.begin());
      }
    }
    return vectors;
  }
  std::vector<SparseEntries> vectors_of(std::span<const int> block, double tolerance) const {
    return few_null_vectors(columns_of(block), tolerance).vectors;
  }

  // On its own bodies: the others of a large scene would cost time for each block.
  Sparse columns_of(std::span<const int> block) const {
    std::vector<Eigen::Index> touched;
    for (const int k : block)
      for (Sparse::InnerIterator it(columns_, k); it; ++it) touched.push_back(it.row());
    std::ranges::sort(touched);
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    Sparse part(static_cast<Eigen::Index>(touched.size()), static_cast<Eigen::Index>(block.size()));
    for (std::size_t c = 0; c < block.size(); ++c) {
      const auto column = static_cast<Eigen::Index>(c);
      part.startVec(column);
      for (Sparse::InnerIterator it(columns_, block[c]); it; ++it)
        part.insertBack(std::ranges::lower_bound(touched, it.row()) - touched.begin(), column) = it.value();
    }
    part.finalize();
    return part;
  }

  std::vector<int> rows_of(std::span<const int> block) const {
    std::vector<int> rows;
    for (const int k : block) rows.push_back(rows_[index(k)]);
    return rows;
  }

  const Model& model_;
  std::span<const int> rows_;
  const Sparse& columns_;
  Lists blocks_;
  std::vector<int> turns_;
};

}  // namespace

NullSpace few_null_vectors(const Eigen::SparseMatrix<double>& columns, double tolerance,
                           const AlsoOfDecomposition& also) {
  return null_space(columns, tolerance, kMostChosen, also);
}

bool many(const NullSpace& null) {
  return null.vectors.size() < null.columns.size();
}

std::vector<int> rows_of_few_groups(const Model& model, std::span<const int> rows, const Sparse& columns,
                                    NullSpace null, double tolerance) {
  const Choice choice(model, rows, columns);
  return many(null) ? choice.by_block(null, tolerance) : choice.at_once(std::move(null.vectors));
}

}  // namespace poinsot
