#pragma once

namespace frond {

/// CPU time that this process has used, all threads together.
double cpu_seconds();
/// The calling thread's alone.
double thread_cpu_seconds();

}  // namespace frond
