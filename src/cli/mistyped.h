#pragma once

#include <string>

namespace CLI {
class App;
}

namespace frond {

/// After a parse that failed: which command or long option nothing is called by, and what may have been meant; "" where
/// that is not what went wrong.
std::string mistyped(const CLI::App& app);

}  // namespace frond
