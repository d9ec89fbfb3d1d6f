#pragma once

#include <string>

namespace frond {

/// The processor, its threads and the system: what times depend on.
std::string machine_description();
/// Of this machine, bytes.
double machine_memory();

/// CPU time that this process has used, seconds, all threads together.
double cpu_seconds();
/// The calling thread's alone.
double thread_cpu_seconds();

}  // namespace frond
