#pragma once

namespace frond {

/// Of this machine, bytes.
double machine_memory();

}  // namespace frond
