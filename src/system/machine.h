#pragma once

#include <string>

namespace frond {

/// Returns processor, number of hardware threads and operating system, to be reported with measured times.
std::string machine_description();
/// Returns the physical memory of this machine in bytes.
double machine_memory();

/// Returns the CPU time of this process in seconds, summed over all threads.
double cpu_seconds();
/// Returns the CPU time of the calling thread in seconds.
double thread_cpu_seconds();

}  // namespace frond
