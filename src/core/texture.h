#pragma once

#include <cstring>

#include "core/params.h"
#include "core/plugin.h"
#include "core/shared_work.h"
#include "core/spectrum.h"
#include "core/transform.h"
#include "core/vec.h"

namespace frond {

/// A column of numbers (32-bit floats) in a table of instances.
struct InstanceColumn {
  std::string name;
  size_t offset;   ///< bytes from the beginning of a row
  Interval range;  ///< bounds of its values
};

/// Rows of the tables that an instance of an object comes from, outermost first: a shoot's, then its leaf's.
class InstanceRows {
 public:
  static constexpr uint32_t kMost = 4;

  InstanceRows() {}  // NOLINT(modernize-use-equals-default): rows that are not there are not set to anything
  void add(const std::vector<InstanceColumn>& columns, const std::byte* row) { rows_[count_++] = {&columns, row}; }
  /// The number in the innermost table that has such a column; empty where none has.
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

/// What a texture may know of the point that it is asked for. What comes after the instance is set for those textures
/// alone that `need_details`; 0 elsewhere.
struct TexturePoint {
  Vec2 uv;
  InstanceRows instance = {};
  Vec3 p{};  ///< world space
  Vec3 n{};  ///< shading normal, world space, unit
  /// To where the camera's next sample along x and y of the film would fall: what to filter over.
  Vec3 dp_dx{}, dp_dy{};
  Vec2 duv_dx{}, duv_dy{};
};

/// A number over a surface.
class FloatTexture {
 public:
  virtual ~FloatTexture() = default;
  virtual float evaluate(const TexturePoint& at) const = 0;
  /// Bounds of the values.
  virtual Interval range() const = 0;
  /// Whether values come near to them; those of noise hardly do.
  virtual bool is_range_tight() const { return true; }
  /// Reads more of its points than (u, v) and instance. What it is made of says so for itself.
  virtual bool needs_details() const { return false; }
  bool is_constant() const { return range().min == range().max; }
};

/// A reflectance or transmittance over a surface, in [0, 1] at every wavelength.
class SpectrumTexture {
 public:
  virtual ~SpectrumTexture() = default;
  virtual SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const = 0;
  /// Wavelengths (nm) for which the data stand.
  virtual Interval range_nm() const = 0;
  /// Upper bound of the values.
  virtual float max_value() const = 0;
  /// As of a FloatTexture.
  virtual bool needs_details() const { return false; }
};

/// Made from parameters that hold one number or spectrum, as materials use them.
class ConstantFloatTexture final : public FloatTexture {
 public:
  explicit ConstantFloatTexture(float value) : value_(value) {}
  float evaluate(const TexturePoint&) const override { return value_; }
  Interval range() const override { return {value_, value_}; }

 private:
  float value_;
};

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

/// Where a texture was defined, and among which others.
struct TexturePlacement {
  Transform world_from_texture;
  SharedWork* shared = nullptr;  ///< what textures of one scene have in common; nullptr: each has its own
};

struct FloatTextureInfo : PluginInfo {
  std::unique_ptr<FloatTexture> (*make)(const Params&, const TexturePlacement&);
};
struct SpectrumTextureInfo : PluginInfo {
  std::unique_ptr<SpectrumTexture> (*make)(const Params&, const TexturePlacement&);
};

}  // namespace frond
