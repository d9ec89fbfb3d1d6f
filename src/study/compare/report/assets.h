#pragma once

#include <string_view>

namespace frond::compare {

// Files of src/study/compare/page, embedded into the library by CMake.
extern const std::string_view page_html, page_css, viewer_js;

}  // namespace frond::compare
