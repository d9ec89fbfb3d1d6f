#pragma once

#include <array>

#include "core/camera.h"
#include "core/filter.h"
#include "core/integrator.h"
#include "core/wavelengths.h"

namespace frond {

class CameraMotion;

/// Pixel coordinates in the whole image.
struct PixelPosition {
  int x, y;
};

/// Parts of a scene that determine its camera samples; they must outlive this record.
struct CameraSampling {
  const Camera& camera;
  const WavelengthStrategy& wavelengths;
  const Sampler& sampler;             ///< its seed is also the seed of the paths' random streams
  int width, height;                  ///< of the whole image, pixels
  bool pixel_jitter;                  ///< false: all samples at the centres of the pixel and of the lens, unfiltered
  bool wavelength_jitter;             ///< false: all samples have the same wavelengths
  bool has_motion;                    ///< rays need a time
  const CameraMotion* camera_motion;  ///< nullptr: the camera stands still

  /// Returns a random pixel of the whole image, by its index.
  PixelPosition random_pixel(uint64_t index) const;
};

/// Makes camera samples, a bundle of one pixel at a time, for one thread: positions in the pixel, on the lens and in
/// time, wavelengths, rays, and keys of random streams.
class CameraSamples {
 public:
  /// Positions in the pixel are importance samples of `filter`; nullptr: they are uniform. The arguments must outlive
  /// this object.
  CameraSamples(const CameraSampling& sampling, const Filter* filter);

  /// Sets the bundle to the samples `first` to `first + PathBundle::kSize - 1` of a pixel. `wanted`: as in PathBundle.
  /// `first_wavelength_index`: index of the first sample for WavelengthStrategy::sample_for_index.
  void make(PixelPosition pixel, uint64_t first, uint32_t wanted, uint64_t first_wavelength_index);
  void make(PixelPosition pixel, uint64_t first, uint32_t wanted) { make(pixel, first, wanted, first); }

  PathBundle& bundle() { return bundle_; }
  /// Offset from the pixel's centre, and weight, of a sample of the bundle.
  const Filter::Sample& position(size_t lane) const { return positions_[lane]; }

 private:
  const CameraSampling& sampling_;
  const Filter* filter_;
  bool has_fixed_wavelengths_;
  PathBundle bundle_;
  std::array<Filter::Sample, PathBundle::kSize> positions_;
};

}  // namespace frond
