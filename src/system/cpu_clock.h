#pragma once

namespace frond {

/// CPU time that this process has used, all threads together.
double cpu_seconds();

}  // namespace frond
