#include <algorithm>

#include "core/error.h"
#include "core/texture.h"

// Texture "instance": a column of the instance table of an object.

namespace frond {
namespace {

/// Returns the column's value of the innermost instance that has the column.
class InstanceTexture final : public FloatTexture {
 public:
  explicit InstanceTexture(const Params& p) : column_(p.string("column")) {
    const std::vector<double> range = p.reals("range");
    if (range.size() != 2) fail(p.where("range"), "\"range\" takes 2 values, {} given", range.size());
    if (range[0] > range[1])
      fail(p.where("range"), "\"range\" goes from the least to the largest value: {} is more than {}", range[0],
           range[1]);
    range_ = {range[0], range[1]};
    elsewhere_ = p.given("default") ? p.real("default") : range_.min;
    if (!range_.contains(elsewhere_)) fail(p.where("default"), "\"default\" {} is outside \"range\"", elsewhere_);
  }
  /// Values are clamped to "range", which bounds them for materials that compute tables.
  float evaluate(const TexturePoint& at) const override {
    const double value = double(at.instance.find(column_).value_or(float(elsewhere_)));
    return float(std::clamp(value, range_.min, range_.max));
  }
  Interval range() const override { return range_; }

 private:
  std::string column_;
  Interval range_;
  double elsewhere_;  ///< value where no instance has the column
};

constexpr Param kInstanceTexture[] = {
    {.name = "column", .kind = ParamKind::string, .doc = "Column of the instance table.", .required = true},
    {.name = "range",
     .kind = ParamKind::real,
     .doc = "Minimum and maximum; values beyond are clamped.",
     .list = true,
     .required = true},
    {.name = "default",
     .kind = ParamKind::real,
     .doc = "Value on surfaces that are not instances with this column; by default the minimum of \"range\"."}};

std::unique_ptr<FloatTexture> make_instance_texture(const Params& p, const TexturePlacement&) {
  return std::make_unique<InstanceTexture>(p);
}

}  // namespace

extern const FloatTextureInfo instance_float_texture{
    {"float texture", "instance", "Number from the instance table, for each instance of an object.", "",
     kInstanceTexture},
    make_instance_texture};

}  // namespace frond
