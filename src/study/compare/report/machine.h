#pragma once

#include <string>

namespace frond::compare {

/// The processor, its threads and the system: what times depend on.
std::string machine_description();

}  // namespace frond::compare
