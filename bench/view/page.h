// The page of `poinsot view`: one HTML file that needs nothing beside it and asks nothing of a network.
//
// Its script and style (bench/view/page) are bundled when the program is built, where npm was found; without it there
// is no page.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "bench/view/frames.h"
#include "core/model.h"

namespace poinsot::view {

// Why there is no page and what to do; empty where there is one.
std::string_view missing_page();

// Throws InputError where there is no page.
std::string page(const Model& model, const std::string& about, std::span<const Motion> motions);

}  // namespace poinsot::view
