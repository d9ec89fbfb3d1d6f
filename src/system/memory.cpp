#include "system/memory.h"

#include <unistd.h>

namespace frond {

double machine_memory() { return double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)); }

}  // namespace frond
