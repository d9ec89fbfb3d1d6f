#pragma once

#include <span>

#include "core/spectrum.h"

namespace frond {

/// The same spectrum, which knows its values at these wavelengths (nm, kLanes at most): where every path carries them,
/// nothing has to be looked up.
SpectrumPtr known_at(SpectrumPtr spectrum, std::span<const float> nm);

}  // namespace frond
