#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/log.h"
#include "render/session.h"
#include "scene/format/words.h"

namespace frond::test {

/// A sphere, a panel and much empty sky, 40 x 27 pixels: tiles at the right and below are not whole.
inline std::string a_scene(const std::string& more = "", int width = 40, int height = 27) {
  return fmt::format(R"(
LookAt 0 .5 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" {} "integer yresolution" {}
Sampler "lattice" "integer pixelsamples" 4
PixelFilter "gaussian"
Integrator "path" "integer maxdepth" 3
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
LightSource "distant" "point3 from" [1 2 1] "point3 to" [0 0 0] "spectrum L" "stdillum-D65"
MakeNamedMaterial "floor" "string type" "diffuse" "rgb reflectance" [.5 .4 .3]
MakeNamedMaterial "thing" "string type" "diffusetransmission" "rgb reflectance" [.2 .5 .1]
NamedMaterial "floor"
Shape "trianglemesh" "point3 P" [-2 -.5 -2  2 -.5 -2  2 -.5 2  -2 -.5 2] "integer indices" [0 1 2  0 2 3]
NamedMaterial "thing"
Shape "sphere" "float radius" .5
{})",
                     width, height, more);
}

/// A mesh of one triangle, `size` high.
inline std::string triangle(double size) {
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n-1 0 0\n1 0 0\n0 {} 0\n3 0 1 2\n",
      size);
}

/// How a scene's file is rendered.
struct SceneRender {
  std::string wavelengths = "hero";
  std::vector<std::string> channels = {};
  std::optional<Crop> pixels = {};
  bool is_part = true;  ///< where pixels are given: others are rendered elsewhere
  uint64_t seed = 1;
  int threads = 2;
  std::string swap = {};  ///< of "thing"
  std::string integrator = {};
  std::string filter = {};
  bool adaptive = false;

  LoadedScene load(Session& session, const std::filesystem::path& scene) const {
    SceneOverrides overrides;
    overrides.wavelengths = wavelengths;
    overrides.seed = seed;
    if (!swap.empty()) overrides.swaps.push_back({"thing", parse_plugin_text(swap, {}), {}});
    if (!integrator.empty()) overrides.integrator = parse_plugin_text(integrator, {});
    if (!filter.empty()) overrides.filter = parse_plugin_text(filter, {});
    SceneDescription description = session.read(scene);
    apply_overrides(overrides, description, session.registry(), session.log());
    return session.load(std::move(description),
                        {.pixels = pixels, .is_part = is_part, .channels = channels, .adaptive = adaptive});
  }
  RenderPart part(const std::filesystem::path& scene, SampleRange samples) const {
    Session session(silent_log(), {.threads = threads});
    const LoadedScene loaded = load(session, scene);
    RenderPart result = loaded.empty_part();
    session.render(loaded, samples, result);
    return result;
  }
};

}  // namespace frond::test
