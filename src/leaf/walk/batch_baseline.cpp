#include "leaf/walk/batch_event.h"

namespace frond::leaf::batch {

const Kernel kBaseline = kernel("baseline");

}  // namespace frond::leaf::batch
