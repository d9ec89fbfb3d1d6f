#include "scene/instances.h"

#include <algorithm>

#include "core/error.h"
#include "scene/format/plugin_text.h"
#include "scene/registry.h"
#include "scene/shape.h"

// Copies of an object by the million, and textures that follow their numbers.

namespace frond {

extern const FloatTextureInfo instance_float_texture;

namespace {

constexpr Param kInstances[] = {{.name = "object",
                                 .kind = ParamKind::string,
                                 .doc = "The name of the object that is copied (ObjectBegin).",
                                 .required = true},
                                {.name = "filename",
                                 .kind = ParamKind::string,
                                 .doc = "Table of the copies: a NumPy file (.npy), a row for each, of \"transform\" "
                                        "(the three rows of a matrix) and any other numbers, all of them float32.",
                                 .required = true}};

MadeShape make_instances(const Params& p, const ShapePlacement&) {
  return ObjectCopies{.object = p.string("object"), .table = p.file("filename")};
}

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
  float evaluate(const TexturePoint& at) const override {
    const double value = double(at.instance.find(column_).value_or(float(elsewhere_)));
    return float(std::clamp(value, range_.min, range_.max));
  }
  Interval range() const override { return range_; }

 private:
  std::string column_;
  Interval range_;
  double elsewhere_;
};

constexpr Param kInstanceTexture[] = {
    {.name = "column", .kind = ParamKind::string, .doc = "Which number of the table.", .required = true},
    {.name = "range",
     .kind = ParamKind::real,
     .doc = "The least and the largest value; what lies beyond is taken as that.",
     .list = true,
     .required = true},
    {.name = "default",
     .kind = ParamKind::real,
     .doc = "Value where a surface is no copy with such a number; the least of \"range\" by default."}};

std::unique_ptr<FloatTexture> make_instance_texture(const Params& p, const TexturePlacement&) {
  return std::make_unique<InstanceTexture>(p);
}

}  // namespace

void check_instance_textures(const SceneSettings& description, const Geometry& geometry, const Log& log) {
  const std::vector<InstanceColumn> columns = geometry.columns();
  std::vector<std::string_view> names;
  for (const InstanceColumn& c : columns) names.push_back(c.name);
  for (const TextureDescription& texture : description.textures) {
    if (texture.plugin.name != instance_float_texture.name) continue;
    const ParsedParam& name = *find_param(texture.plugin.params, "column");  // it is required, and a single one
    const std::string& wanted = std::get<std::vector<std::string>>(name.values).front();
    const auto column = std::ranges::find(columns, wanted, &InstanceColumn::name);
    if (column == columns.end())
      fail(name.value_where, "no table of copies has a column \"{}\"{}", wanted,
           names.empty() ? ": none has any numbers beside \"transform\"" : suggestion(wanted, names));
    const auto& range = std::get<std::vector<double>>(find_param(texture.plugin.params, "range")->values);
    if (column->range.min < range[0] || column->range.max > range[1])
      log.warn(name.value_where,
               fmt::format("column \"{}\" goes from {:g} to {:g}: what is beyond \"range\" is taken as its ends",
                           wanted, column->range.min, column->range.max));
  }
}

extern const ShapeInfo instances_shape{
    {"shape", "instances", "Copies of an object, a row of a table for each.", "", kInstances}, make_instances};
extern const FloatTextureInfo instance_float_texture{
    {"float texture", "instance", "A number of the table that a copy of an object comes from.", "", kInstanceTexture},
    make_instance_texture};

}  // namespace frond
