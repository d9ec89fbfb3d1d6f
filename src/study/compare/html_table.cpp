#include "study/compare/html_table.h"

#include <fmt/format.h>

namespace frond::compare {

std::string cell(const std::string& text) { return "<td>" + text + "</td>"; }

std::string head(const std::vector<std::string>& titles) {
  std::string row = "<thead><tr>";
  for (const std::string& t : titles) row += fmt::format("<th scope=\"col\">{}</th>", t);
  return row + "</tr></thead>";
}

std::string table(const std::string& title, const std::string& header, const std::string& rows,
                  const std::string& note) {
  return fmt::format(
      "<h3>{}</h3>\n<div class=\"scroll\"><table>{}<tbody>\n{}</tbody></table></div>\n<p class=\"note\">{}</p>\n",
      title, header, rows, note);
}

}  // namespace frond::compare
