#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/texture.h"
#include "textures/clamped.h"

namespace frond {
namespace {

/// Product of two float textures.
class ScaleFloat final : public FloatTexture {
 public:
  explicit ScaleFloat(const Params& p) : tex_(p.float_texture("tex")), scale_(p.float_texture("scale")) {}
  float evaluate(const TexturePoint& at) const override { return tex_->evaluate(at) * scale_->evaluate(at); }
  /// Extreme products occur at the corners of the ranges.
  Interval range() const override {
    const Interval a = tex_->range(), b = scale_->range();
    const auto corners = {a.min * b.min, a.min * b.max, a.max * b.min, a.max * b.max};
    return {std::min(corners), std::max(corners)};
  }
  bool is_range_tight() const override { return tex_->is_range_tight() && scale_->is_range_tight(); }

 private:
  std::shared_ptr<const FloatTexture> tex_, scale_;
};

/// Product of a spectrum and a number, clamped to [0, 1] where it may exceed that.
class ScaleSpectrum final : public SpectrumTexture {
 public:
  explicit ScaleSpectrum(const Params& p) : tex_(p.spectrum_texture("tex")), scale_(p.float_texture("scale")) {
    const Interval r = scale_->range();
    const double most = r.max * double(tex_->max_value());
    is_clamped_ = r.min < 0 || most > 1;
    if (is_clamped_ && scale_->is_range_tight())
      p.warn("scale", fmt::format("this takes \"tex\", up to {:.3g}, out of [0, 1], for it is {:.3g} to {:.3g}: the "
                                  "product is clamped",
                                  tex_->max_value(), r.min, r.max));
  }
  SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const override {
    const SampledSpectrum product = tex_->evaluate(at, lambda) * scale_->evaluate(at);
    if (!is_clamped_) return product;
    return SampledSpectrum(clamped_to_unit(product.v));
  }
  Interval range_nm() const override { return tex_->range_nm(); }
  float max_value() const override { return std::clamp(tex_->max_value() * float(scale_->range().max), 0.f, 1.f); }

 private:
  std::shared_ptr<const SpectrumTexture> tex_;
  std::shared_ptr<const FloatTexture> scale_;
  bool is_clamped_ = false;  ///< whether the bounds of the factors allow products outside [0, 1]
};

/// Linear interpolation of two float textures; as in pbrt-v4, amounts outside [0, 1] extrapolate.
class MixFloat final : public FloatTexture {
 public:
  explicit MixFloat(const Params& p)
      : a_(p.float_texture("tex1")), b_(p.float_texture("tex2")), amount_(p.float_texture("amount")) {}
  float evaluate(const TexturePoint& at) const override {
    const float t = amount_->evaluate(at);
    return (1 - t) * a_->evaluate(at) + t * b_->evaluate(at);
  }
  /// Extreme values occur at the corners of the ranges.
  Interval range() const override {
    const Interval a = a_->range(), b = b_->range(), t = amount_->range();
    Interval all{INFINITY, -INFINITY};
    for (const double x : {a.min, a.max})
      for (const double y : {b.min, b.max})
        for (const double s : {t.min, t.max}) {
          const double value = (1 - s) * x + s * y;
          all = {std::min(all.min, value), std::max(all.max, value)};
        }
    return all;
  }
  bool is_range_tight() const override {
    return a_->is_range_tight() && b_->is_range_tight() && amount_->is_range_tight();
  }

 private:
  std::shared_ptr<const FloatTexture> a_, b_, amount_;
};

/// Linear interpolation of two spectrum textures. Amounts outside [0, 1] extrapolate; the result is clamped to [0, 1],
/// as pbrt-v4's materials clamp it.
class MixSpectrum final : public SpectrumTexture {
 public:
  explicit MixSpectrum(const Params& p)
      : a_(p.spectrum_texture("tex1")), b_(p.spectrum_texture("tex2")), amount_(p.float_texture("amount")) {
    const Interval t = amount_->range();
    extrapolates_ = t.min < 0 || t.max > 1;
  }
  SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const override {
    const float t = amount_->evaluate(at);
    const SampledSpectrum mixed = (1 - t) * a_->evaluate(at, lambda) + t * b_->evaluate(at, lambda);
    return extrapolates_ ? SampledSpectrum(clamped_to_unit(mixed.v)) : mixed;
  }
  Interval range_nm() const override {
    const Interval a = a_->range_nm(), b = b_->range_nm();
    return {std::max(a.min, b.min), std::min(a.max, b.max)};
  }
  float max_value() const override {
    const float a = a_->max_value(), b = b_->max_value(), above = std::max(1.f, float(amount_->range().max)),
                below = std::min(0.f, float(amount_->range().min));
    const float most = std::max({a, b, above * b, (1 - below) * a});
    return extrapolates_ ? std::min(most, 1.f) : most;
  }

 private:
  std::shared_ptr<const SpectrumTexture> a_, b_;
  std::shared_ptr<const FloatTexture> amount_;
  bool extrapolates_;  ///< whether the range of the amount exceeds [0, 1]
};

/// A constant needs no texture mapping.
std::unique_ptr<FloatTexture> make_constant_float(const Params& p, const TexturePlacement&) {
  return std::make_unique<ConstantFloatTexture>(float(p.real("value")));
}

std::unique_ptr<SpectrumTexture> make_constant_spectrum(const Params& p, const TexturePlacement&) {
  return std::make_unique<ConstantSpectrumTexture>(p.spectrum("value"));
}

template <class Base, class T>
std::unique_ptr<Base> make_unplaced(const Params& p, const TexturePlacement&) {
  return std::make_unique<T>(p);
}

constexpr Param kFactor{.name = "scale", .kind = ParamKind::float_texture, .default_value = 1.0, .doc = "Factor."};
constexpr Param kAmount{.name = "amount",
                        .kind = ParamKind::float_texture,
                        .default_value = 0.5,
                        .doc = "Share of the second texture; outside 0 to 1 it extrapolates."};
constexpr Param kConstantFloat[] = {{.name = "value", .kind = ParamKind::real, .default_value = 1.0, .doc = "Value."}};
constexpr Param kConstantSpectrum[] = {
    {.name = "value", .kind = ParamKind::albedo, .default_value = 1.0, .doc = "Value."}};
constexpr Param kScaleFloat[] = {
    {.name = "tex", .kind = ParamKind::float_texture, .default_value = 1.0, .doc = "Texture to scale."}, kFactor};
constexpr Param kScaleSpectrum[] = {
    {.name = "tex", .kind = ParamKind::spectrum_texture, .default_value = 1.0, .doc = "Texture to scale."}, kFactor};
constexpr Param kMixFloat[] = {
    {.name = "tex1", .kind = ParamKind::float_texture, .default_value = 0.0, .doc = "First texture."},
    {.name = "tex2", .kind = ParamKind::float_texture, .default_value = 1.0, .doc = "Second texture."},
    kAmount};
constexpr Param kMixSpectrum[] = {
    {.name = "tex1", .kind = ParamKind::spectrum_texture, .default_value = 0.0, .doc = "First texture."},
    {.name = "tex2", .kind = ParamKind::spectrum_texture, .default_value = 1.0, .doc = "Second texture."},
    kAmount};

}  // namespace

extern const FloatTextureInfo constant_float_texture{
    {"float texture", "constant", "Constant number.", "pbrt-v4", kConstantFloat}, make_constant_float};
extern const FloatTextureInfo scale_float_texture{
    {"float texture", "scale", "Product of two textures.", "pbrt-v4", kScaleFloat},
    make_unplaced<FloatTexture, ScaleFloat>};
extern const FloatTextureInfo mix_float_texture{
    {"float texture", "mix", "Mixture of two textures.", "pbrt-v4", kMixFloat}, make_unplaced<FloatTexture, MixFloat>};
extern const SpectrumTextureInfo constant_spectrum_texture{
    {"spectrum texture", "constant", "Constant spectrum.", "pbrt-v4", kConstantSpectrum}, make_constant_spectrum};
extern const SpectrumTextureInfo scale_spectrum_texture{
    {"spectrum texture", "scale", "Product of a texture and a number.", "pbrt-v4", kScaleSpectrum},
    make_unplaced<SpectrumTexture, ScaleSpectrum>};
extern const SpectrumTextureInfo mix_spectrum_texture{
    {"spectrum texture", "mix", "Mixture of two textures.", "pbrt-v4", kMixSpectrum},
    make_unplaced<SpectrumTexture, MixSpectrum>};

}  // namespace frond
