#pragma once

#include <string_view>

namespace frond::compare {

// The files of src/study/compare/page, put into the library by CMake.
extern const std::string_view page_html, page_css, viewer_js;

}  // namespace frond::compare
