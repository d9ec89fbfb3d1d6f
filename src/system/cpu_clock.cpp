#include "system/cpu_clock.h"

#include <ctime>

namespace frond {
namespace {

double seconds(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return double(t.tv_sec) + double(t.tv_nsec) * 1e-9;
}

}  // namespace

double cpu_seconds() { return seconds(CLOCK_PROCESS_CPUTIME_ID); }

double thread_cpu_seconds() { return seconds(CLOCK_THREAD_CPUTIME_ID); }

}  // namespace frond
