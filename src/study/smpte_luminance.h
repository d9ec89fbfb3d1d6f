#pragma once

namespace frond {

/// Returns the luminance of linear SMPTE-C (white D65 at 0.3127, 0.3290).
constexpr float smpte_luminance(float r, float g, float b) { return 0.2124f * r + 0.7011f * g + 0.0866f * b; }

}  // namespace frond
