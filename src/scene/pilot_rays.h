#pragma once

#include "core/integrator.h"

namespace frond {

class Scene;

/// Camera rays of a scene (PilotRays), which depend only on the scene and its seed.
class ScenePilotRays final : public PilotRays {
 public:
  /// `scene` must outlive the object.
  explicit ScenePilotRays(const Scene& scene) : scene_(scene) {}
  PathBundle bundle(uint64_t pixel, uint64_t number) const override;
  std::array<double, 3> color(const SampledSpectrum& radiance, const SampledWavelengths& lambda) const override;

 private:
  const Scene& scene_;
};

}  // namespace frond
