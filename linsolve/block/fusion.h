// What makes a body or a group regular that an elimination has found not to be so: it is fused with others.
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

}  // namespace poinsot::block
