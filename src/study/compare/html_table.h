#pragma once

#include <string>
#include <vector>

namespace frond::compare {

// Parts of a table; texts are HTML already.

std::string cell(const std::string& text);

/// A row of titles of columns.
std::string head(const std::vector<std::string>& titles);

std::string table(const std::string& title, const std::string& header, const std::string& rows,
                  const std::string& note);

}  // namespace frond::compare
