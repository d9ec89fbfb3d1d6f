#pragma once

#include <cstring>

#include "core/math/transform.h"
#include "core/math/vec.h"
#include "core/params.h"
#include "core/plugin.h"
#include "core/shared_work.h"
#include "core/spectrum.h"

namespace frond {

/// Column of 32-bit floats in an instance table.
struct InstanceColumn {
  std::string name;
  size_t offset;   ///< in bytes from the beginning of a row
  Interval range;  ///< smallest and largest value
};

/// Rows of the instance tables that placed an object, outermost first: for a leaf of a shoot the shoot's row, then the
/// leaf's.
class InstanceRows {
 public:
  static constexpr uint32_t kMost = 4;  ///< deepest nesting of instances

  InstanceRows() {}  // NOLINT(modernize-use-equals-default): leaves the unused rows uninitialized
  void add(const std::vector<InstanceColumn>& columns, const std::byte* row) { rows_[count_++] = {&columns, row}; }
  /// Value of the column in the innermost table that has it; empty if no table has it.
  std::optional<float> find(std::string_view column) const {
    for (uint32_t i = count_; i-- > 0;)
      for (const InstanceColumn& c : *rows_[i].columns)
        if (c.name == column) {
          float value;
          std::memcpy(&value, rows_[i].bytes + c.offset, sizeof value);
          return value;
        }
    return {};
  }

 private:
  struct Row {
    const std::vector<InstanceColumn>* columns;
    const std::byte* bytes;
  };
  std::array<Row, kMost> rows_;
  uint32_t count_ = 0;
};

/// Surface point at which a texture is evaluated. The members after `instance` are set only for textures whose
/// `needs_details` is true; else they are 0.
struct TexturePoint {
  Vec2 uv;
  InstanceRows instance = {};
  Vec3 p{};  ///< world space
  Vec3 n{};  ///< shading normal, world space, unit
  /// Change of p and uv from this camera sample to the next one in x and y of the film: the footprint to filter over.
  Vec3 dp_dx{}, dp_dy{};
  Vec2 duv_dx{}, duv_dy{};
};

/// Scalar texture. Thread-safe.
class FloatTexture {
 public:
  virtual ~FloatTexture() = default;
  virtual float evaluate(const TexturePoint& at) const = 0;
  /// Bounds of the values.
  virtual Interval range() const = 0;
  /// True if values come close to both bounds; false for bounds that are rarely approached, such as the bounds of
  /// noise.
  virtual bool is_range_tight() const { return true; }
  /// True if the texture itself reads more of a TexturePoint than `uv` and `instance`. Textures that it is made of
  /// report this separately.
  virtual bool needs_details() const { return false; }
  bool is_constant() const { return range().min == range().max; }
};

/// Spectral texture: a reflectance or transmittance, in [0, 1] at every wavelength. Thread-safe.
class SpectrumTexture {
 public:
  virtual ~SpectrumTexture() = default;
  virtual SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const = 0;
  /// Wavelengths (nm) for which there are data.
  virtual Interval range_nm() const = 0;
  /// Upper bound of the values.
  virtual float max_value() const = 0;
  /// See FloatTexture::needs_details.
  virtual bool needs_details() const { return false; }
};

/// Texture of a parameter that is a number.
class ConstantFloatTexture final : public FloatTexture {
 public:
  explicit ConstantFloatTexture(float value) : value_(value) {}
  float evaluate(const TexturePoint&) const override { return value_; }
  Interval range() const override { return {value_, value_}; }

 private:
  float value_;
};

/// Texture of a parameter that is a spectrum.
class ConstantSpectrumTexture final : public SpectrumTexture {
 public:
  explicit ConstantSpectrumTexture(SpectrumPtr value) : value_(std::move(value)) {}
  SampledSpectrum evaluate(const TexturePoint&, const SampledWavelengths& lambda) const override {
    return value_->sample(lambda);
  }
  Interval range_nm() const override { return value_->range_nm(); }
  float max_value() const override { return value_->max_value(); }

 private:
  SpectrumPtr value_;
};

/// Context in which a texture is made.
struct TexturePlacement {
  Transform world_from_texture;  ///< the current transformation at the texture's definition
  SharedWork* shared = nullptr;  ///< results shared by the textures of a scene; nullptr: nothing is shared
};

/// Plug-in record of a scalar texture. `make` returns a texture, not null, and throws InputError.
struct FloatTextureInfo : PluginInfo {
  std::unique_ptr<FloatTexture> (*make)(const Params&, const TexturePlacement&);
};
/// Plug-in record of a spectral texture. `make` returns a texture, not null, and throws InputError.
struct SpectrumTextureInfo : PluginInfo {
  std::unique_ptr<SpectrumTexture> (*make)(const Params&, const TexturePlacement&);
};

}  // namespace frond
