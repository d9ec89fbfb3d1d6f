#include "core/camera_samples.h"

#include <algorithm>

#include "core/math/motion.h"

namespace frond {
namespace {

/// The lanes of all packets that contain a wanted one: the rays that are traced together do not depend on which samples
/// are wanted.
uint32_t whole_packets(uint32_t wanted) {
  constexpr uint32_t kPacket = (1u << RayPacket::kWidth) - 1;
  uint32_t lanes = 0;
  for (uint32_t packet = kPacket; packet < 1u << PathBundle::kSize; packet <<= RayPacket::kWidth)
    if (wanted & packet) lanes |= packet;
  return lanes;
}

}  // namespace

PixelPosition CameraSampling::random_pixel(uint64_t index) const {
  RandomStream random(hash_key(sampler.seed(), index));
  const int x = int(random.uniform() * float(width)), y = int(random.uniform() * float(height));
  return {std::min(x, width - 1), std::min(y, height - 1)};  // the products may be rounded up
}

CameraSamples::CameraSamples(const CameraSampling& sampling, const Filter* filter)
    : sampling_(sampling),
      filter_(filter),
      has_fixed_wavelengths_(!sampling.wavelengths.fixed_nm().empty()),
      bundle_{.sampler = sampling.sampler} {
  if (has_fixed_wavelengths_) bundle_.lambda.fill(sampling.wavelengths.sample(0));
}

void CameraSamples::make(PixelPosition pixel, uint64_t first, uint32_t wanted, uint64_t first_wavelength_index) {
  constexpr size_t kMost = PathBundle::kSize;
  const Camera& camera = sampling_.camera;
  const Sampler& sampler = sampling_.sampler;
  PathBundle& b = bundle_;
  b.samples = {pixel.x, pixel.y, first, uint32_t(kMost)};
  b.wanted = wanted;
  b.lanes = whole_packets(wanted);
  std::array<float, kMost> on_spectrum, time;
  std::array<Vec2, kMost> in_pixel, on_film, on_lens{};
  const uint64_t seed = sampler.seed();
  const bool is_centred = !sampling_.pixel_jitter || camera.pixels_are_apart();
  if (!is_centred) sampler.get2d(b.samples, uint32_t(Dimension::film), in_pixel.data());
  if (!sampling_.pixel_jitter)
    on_lens.fill({0.5f, 0.5f});
  else if (camera.uses_lens())
    sampler.get2d(b.samples, uint32_t(Dimension::lens), on_lens.data());
  if (!sampling_.wavelength_jitter)
    on_spectrum.fill(0.5f);
  else if (!has_fixed_wavelengths_)
    sampler.get1d(b.samples, uint32_t(Dimension::wavelengths), on_spectrum.data());
  for (size_t i = 0; i < kMost; ++i) {
    if (!(b.lanes >> i & 1)) continue;
    if (is_centred)
      positions_[i] = {{0, 0}, 1};
    else if (filter_)
      positions_[i] = filter_->sample(in_pixel[i]);
    else
      positions_[i] = {{in_pixel[i].x - 0.5f, in_pixel[i].y - 0.5f}, 1};
    const Vec2 offset = positions_[i].offset;
    on_film[i] = {float(pixel.x) + 0.5f + offset.x, float(pixel.y) + 0.5f + offset.y};
    if (!has_fixed_wavelengths_)
      b.lambda[i] = sampling_.wavelengths.sample_for_index(first_wavelength_index + i, on_spectrum[i]);
    b.keys[i] = sample_key(seed, pixel.x, pixel.y, first + i);
  }
  for (size_t i = 0; i < kMost; i += RayPacket::kWidth)
    if (b.lanes >> i & 1) camera.rays(&on_film[i], &on_lens[i], RayPacket::kWidth, &b.rays[i]);
  if (!sampling_.has_motion) return;
  sampler.get1d(b.samples, uint32_t(Dimension::time), time.data());
  for (size_t i = 0; i < kMost; ++i) {
    b.rays[i].time = time[i];
    if (sampling_.camera_motion && (b.lanes >> i & 1)) sampling_.camera_motion->move(b.rays[i]);
  }
}

}  // namespace frond
