#include <algorithm>

#include "bench/cases/case_table.h"

namespace poinsot::cases {

Selection::Selection(const Study& study, bool quick, int place, int places)
    : all_(study.size()), first_(place - 1), every_(places) {
  std::int64_t whole = all_;
  if (quick) {
    std::vector<std::int64_t> sizes{static_cast<std::int64_t>(study.scenes.size())};
    for (const ParameterAxis& axis : study.axes) sizes.push_back(axis.size());
    sizes.push_back(static_cast<std::int64_t>(study.settings.size()));
    std::int64_t inner = 1;
    for (std::size_t d = sizes.size(); d-- > 0; inner *= sizes[d]) {
      if (sizes[d] <= length_) continue;
      length_ = sizes[d];
      inner_ = inner;
    }
    stride_ = kStride;
    whole = all_ / length_ * ((length_ + stride_ - 1) / stride_);
  }
  size_ = whole > first_ ? (whole - first_ + every_ - 1) / every_ : 0;
}

std::int64_t Selection::at(std::int64_t k) const {
  const std::int64_t n = first_ + k * every_, within = n % inner_, shortened = (length_ + stride_ - 1) / stride_;
  const std::int64_t outer = n / inner_ / shortened, j = n / inner_ % shortened;
  // 0, 11, 22, ...: what goes by turns along the dimension is met in all its kinds.
  const std::int64_t place = std::min(j * stride_ + j % stride_, length_ - 1);
  return (outer * length_ + place) * inner_ + within;
}

}  // namespace poinsot::cases
