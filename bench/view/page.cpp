#include "bench/view/page.h"

#include "bench/view/bundle.h"
#include "bench/view/page_data.h"
#include "core/input_error.h"

namespace poinsot::view {

std::string_view missing_page() {
  if (!bundle_before().empty()) return {};
  return "view: this program was built without the page; install npm (Debian: npm), configure and build again";
}

std::string page(const Model& model, const std::string& about, std::span<const Motion> motions) {
  if (!missing_page().empty()) throw InputError(std::string(missing_page()));
  std::string text;
  for (const std::string_view part : bundle_before()) text += part;
  text += page_data(model, about, motions);
  for (const std::string_view part : bundle_after()) text += part;
  return text;
}

}  // namespace poinsot::view
