// What makes a body or a group regular that an elimination has found not to be so, or cannot find to be: it is fused
// with others.
#pragma once

#include <span>
#include <vector>

#include "linsolve/block/schedule.h"
#include "linsolve/csc_layout.h"

namespace poinsot::block {

// A body that is not regular by itself takes in a group of its constraints; a group that was a pivot too early goes to
// the last of its bodies. Where all of these were before it, it waits for a hub: the nearest group that has one goes
// there in its place, at once and not by way of the groups between. `bad`: such pivots, by place; `fused`: by node,
// what takes it in, or −1. False where nothing is left to fuse, and where a body would take in more than share a front:
// its own six unknowns cannot be why all these are bad.
bool fuse(const CscLayout& layout, std::span<const int> node, const Schedule& schedule, std::span<const int> bad,
          std::vector<int>& fused);

// Before anything is eliminated: where hubs do not move the mechanism falls apart, and a part with more rows than its
// bodies have freedoms holds hubs, too. As many of its groups go into theirs as have these rows; an elimination would
// find that out at the price of another. Which rows hold hubs beyond that, numbers tell.
void fuse_with_hubs(const CscLayout& layout, std::span<const int> node, std::vector<int>& fused);

}  // namespace poinsot::block
