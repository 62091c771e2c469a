// The formulations' makers: each is compiled in a file of its own and listed in formulations/registry.cpp.
#pragma once

#include <memory>
#include <span>

#include "formulations/problem.h"

namespace poinsot {

std::unique_ptr<Problem> make_rA(std::shared_ptr<const Model> model, std::span<const int> dropped);
std::unique_ptr<Problem> make_rp(std::shared_ptr<const Model> model, std::span<const int> dropped);
std::unique_ptr<Problem> make_reps(std::shared_ptr<const Model> model, std::span<const int> dropped);

}  // namespace poinsot
