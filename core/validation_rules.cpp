#include "core/validation_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/json_value.h"

namespace poinsot::rules {
namespace {

bool is_utf8(const std::string& text) {
  if (std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; })) return true;
  try {
    (void)nlohmann::json(text).dump();
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
  return true;
}

}  // namespace

void finite(const Place& at, std::string_view key, double x) {
  if (!std::isfinite(x)) at.fail(key, fmt::format("found {}, expected a finite number", x));
}
void finite(const Place& at, std::string_view key, const Eigen::Ref<const Eigen::MatrixXd>& x) {
  if (x.allFinite()) return;
  for (Eigen::Index r = 0; r < x.rows(); ++r) {
    for (Eigen::Index c = 0; c < x.cols(); ++c) {
      finite(at, x.cols() == 1 ? fmt::format("{}/{}", key, r) : fmt::format("{}/{}/{}", key, r, c), x(r, c));
    }
  }
}
void finite(const Place& at, std::string_view key, const Expression& f) {
  if (f.is_constant()) finite(at, key, f.at(0.0).f);
}

void positive(const Place& at, std::string_view key, double x) {
  finite(at, key, x);
  constexpr double kLeast = std::numeric_limits<double>::min();  // less is zero within a run (core/flush_subnormals.h)
  if (!(x > 0)) at.fail(key, fmt::format("found {}, expected a positive number", x));
  if (x < kLeast) at.fail(key, fmt::format("found {}, expected a number of at least {:.3g}", x, kLeast));
}

void direction(const Place& at, std::string_view key, const Vector3& x) {
  finite(at, key, x);
  if (x.isZero(0)) at.fail(key, "found the zero vector, expected a direction");
}

void name(const Place& at, const std::string& text) {
  const auto fail = [&](std::string_view expected) {
    using Json = nlohmann::json;
    const Json shown = Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
    at.fail("name", fmt::format("found {}, expected {}", describe(shown), expected));
  };
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::ranges::any_of(text, control)) fail("a name without control characters");
  if (!is_utf8(text)) fail("a name in UTF-8");
}

[[noreturn]] void already(const Place& at, std::string_view key, std::string_view name, std::string_view why,
                          const Place& first) {
  at.fail(key,
          fmt::format("found \"{}\"{}, the name of {} already, expected a name of its own", name, why, first.path()));
}

}  // namespace poinsot::rules
