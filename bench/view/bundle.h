// The page before and after its data, in pieces, as bench/view/page/build.js has made it; none where npm was missing.
#pragma once

#include <span>
#include <string_view>

namespace poinsot::view {

std::span<const std::string_view> bundle_before();
std::span<const std::string_view> bundle_after();

}  // namespace poinsot::view
