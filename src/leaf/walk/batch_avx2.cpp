#include "leaf/walk/batch_event.h"

#if defined(__x86_64__)
namespace frond::leaf::batch {

static_assert(kLanes == 8, "wants its compiler flags, see CMakeLists.txt");
const Kernel kAvx2 = kernel("avx2");

}  // namespace frond::leaf::batch
#endif
