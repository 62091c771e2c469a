// Pieces of HTML. Whatever comes from a file goes through escape(), which leaves nothing that a browser takes for
// markup.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace poinsot::report {

std::string escape(std::string_view text);
// Of a file beside the page, or in a folder beside it.
std::string link(std::string_view file, std::string_view text);

// Columns of numbers are sorted as numbers; where `header` buttons do it is told by the page's script.
std::string table_html(std::string_view caption, const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows);

}  // namespace poinsot::report
