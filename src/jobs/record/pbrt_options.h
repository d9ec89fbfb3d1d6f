#pragma once

namespace frond {

/// An option of pbrt-v4's command line. `frond render` ignores it with a warning, or refuses it and names frond's
/// equivalent.
struct PbrtOption {
  const char* name;
  const char* value;  ///< name of its value; "": a flag
  bool is_refused;
  const char* doc;  ///< reason, or frond's equivalent; "": none
};

inline constexpr PbrtOption kPbrtOptions[] = {
    {"--gpu", "", false, "The CPU renders."},
    {"--gpu-device", "INDEX", false, "The CPU renders."},
    {"--wavefront", "", false, "There is one integrator loop."},
    {"--write-partial-images", "", false, "--checkpoint keeps partial results."},
    {"--pixelstats", "", false, "--channels writes data of each pixel."},
    {"--force-diffuse", "", false, "--swap replaces materials."},
    {"--log-utilization", "", false, ""},
    {"--log-level", "LEVEL", false, ""},
    {"--log-file", "FILE", false, ""},
    {"--displacement-edge-scale", "SCALE", false, "There is no displacement."},
    {"--stats", "", false, "Statistics are always printed."},
    {"--render-coord-sys", "SYSTEM", false, "The image does not depend on it."},
    {"--mse-reference-image", "FILE", true, "frond difference compares images"},
    {"--mse-reference-out", "FILE", true, "frond difference compares images"},
    {"--debugstart", "VALUES", true, "--pixels and --samples render one path again"},
    {"--pixelmaterial", "X,Y", true, "--channels material writes the material of each pixel"},
    {"--interactive", "", true, "frond has no window; --display-server shows the image in a viewer"},
    {"--fullscreen", "", true, "frond has no window"},
    {"--disable-image-textures", "", true, "frond has no such option"},
    {"--format", "", true, "pbrt-v4 itself rewrites scene files"},
    {"--toply", "", true, "pbrt-v4 itself rewrites scene files"},
    {"--upgrade", "", true, "pbrt-v4 itself upgrades files of pbrt-v3"},
};

}  // namespace frond
