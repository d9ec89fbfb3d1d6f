#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "integrators/excitation.h"
#include "integrators/path_tracer.h"

namespace frond {

/// The fluorescence of a scene's materials, each with the wavelengths of excitation that paths draw at it.
class EmittingMaterials {
 public:
  struct Emitter {
    std::shared_ptr<const Fluorescence> fluorescence;
    ExcitationSampler excitation;
  };

  /// `by_material`: by SurfacePoint::material_id; nullptr: the material emits nothing.
  EmittingMaterials(const std::vector<std::shared_ptr<const Fluorescence>>& by_material, const World& world);

  /// Returns nullptr if the material emits nothing.
  const Emitter* find(uint32_t material_id) const {
    return material_id < emitters_.size() && emitters_[material_id] ? &*emitters_[material_id] : nullptr;
  }

 private:
  std::vector<std::optional<Emitter>> emitters_;
};

/// Returns a tracer for one thread of a scene with fluorescence. Paths that carry bands of it have the radiance of the
/// emitted light alone. Other bands and colours are traced by `reflected`; to colours the emitted light is added. The
/// arguments must outlive it.
std::unique_ptr<Tracer> make_fluorescence_tracer(const World& world, const LightSelector& selector,
                                                 const PathSettings& settings, const EmittingMaterials& materials,
                                                 std::unique_ptr<Tracer> reflected);

}  // namespace frond
