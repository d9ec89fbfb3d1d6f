#include "study/compare/report/html.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace frond::compare {

std::string html_text(std::string_view text) {
  std::string html;
  for (const char c : text)
    html += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return html;
}

std::string to_html(const Table& table, const std::string& note) {
  std::string head, body;
  for (const Column& c : table.columns) head += fmt::format("<th scope=\"col\">{}</th>", html_text(c.name));
  for (size_t row = 0; row < table.rows(); ++row) {
    body += "<tr>";
    for (const Column& c : table.columns) body += fmt::format("<td>{}</td>", html_text(std::get<1>(c.values)[row]));
    body += "</tr>\n";
  }
  return fmt::format(
      "<h3>{}</h3>\n<div class=\"scroll\"><table><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n"
      "<p class=\"note\">{}</p>\n",
      html_text(table.name), head, body, html_text(note));
}

std::string base64(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= n ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string half_floats(std::span<const float> values) {
  std::vector<unsigned char> bytes;
  for (const float v : values) {
    constexpr float kLargest = HALF_MAX;
    const uint16_t bits = half(std::isnan(v) ? 0 : std::clamp(v, -kLargest, kLargest)).bits();
    bytes.push_back(static_cast<unsigned char>(bits & 0xff));
    bytes.push_back(static_cast<unsigned char>(bits >> 8));
  }
  return base64(bytes);
}

std::string filled(std::string_view page, const std::map<std::string, std::string>& values) {
  std::string result;
  for (size_t at = 0;;) {
    const size_t open = page.find("{{", at), close = page.find("}}", open);
    result += page.substr(at, open - at);
    if (open == std::string_view::npos) return result;
    const std::string name(page.substr(open + 2, close - open - 2));
    const auto it = values.find(name);
    if (it == values.end()) throw std::logic_error("page: nothing is given for " + name);
    result += it->second;
    at = close + 2;
  }
}

}  // namespace frond::compare
