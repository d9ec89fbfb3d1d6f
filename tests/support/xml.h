#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace frond::test {

/// Returns the first error in the nesting, the entities or the attributes of an XML text without comments and
/// declarations; "" if it is well-formed.
inline std::string xml_error(std::string_view xml) {
  std::vector<std::string> open;
  size_t at = 0;
  while (at < xml.size()) {
    const size_t tag = xml.find('<', at), end = xml.find('>', tag);
    for (size_t i = at; i < std::min(tag, xml.size()); ++i) {
      if (static_cast<unsigned char>(xml[i]) < ' ' && xml[i] != '\n') return "a control character";
      if (xml[i] == '&' && xml.find(';', i) > i + 5) return "a bare &";
    }
    if (tag == std::string_view::npos) break;
    if (end == std::string_view::npos) return "an open tag";
    const std::string_view body = xml.substr(tag + 1, end - tag - 1);
    const std::string name(body.substr(body[0] == '/', body.find_first_of(" /\n", 1) - (body[0] == '/')));
    if (std::count(body.begin(), body.end(), '\'') % 2 != 0) return "an attribute without end: " + std::string(body);
    if (body[0] == '/') {
      if (open.empty() || open.back() != name) return "</" + name + "> does not fit";
      open.pop_back();
    } else if (!body.ends_with('/')) {
      open.push_back(name);
    }
    at = end + 1;
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

}  // namespace frond::test
