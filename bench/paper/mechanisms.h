// The mechanisms of the paper.
#pragma once

#include <array>
#include <string_view>

namespace poinsot::paper {

struct PaperMechanism {
  std::string_view title;
  std::string_view file;  // in the models directory, without .json
  bool driven;            // no free degrees of freedom: kinematics can be computed
};

inline constexpr std::array kMechanisms{PaperMechanism{"Single pendulum", "single_pendulum", true},
                                        PaperMechanism{"Double pendulum", "double_pendulum", false},
                                        PaperMechanism{"Four link", "four_link", true},
                                        PaperMechanism{"Slider crank", "slider_crank", true}};

}  // namespace poinsot::paper
