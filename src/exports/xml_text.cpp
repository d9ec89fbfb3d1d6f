#include "exports/xml_text.h"

namespace frond {

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

std::string xml_comment(std::string_view text) {
  std::string safe = xml_escaped(text);
  for (size_t at = safe.find("--"); at != std::string::npos; at = safe.find("--", at)) safe[at + 1] = ' ';
  return "<!-- " + safe + " -->\n";
}

}  // namespace frond
