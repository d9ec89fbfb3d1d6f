#include "leaf/walk/batch_event.h"

#if defined(__x86_64__)
namespace frond::leaf::batch {

static_assert(kLanes == 16, "wants its compiler flags, see CMakeLists.txt");
const Kernel kAvx512 = kernel("avx512");

}  // namespace frond::leaf::batch
#endif
