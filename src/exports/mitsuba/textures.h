#pragma once

#include <functional>
#include <span>

#include "core/image.h"
#include "exports/mitsuba/context.h"

namespace frond::mitsuba {

/// Value of a material's parameter: a constant or an image.
struct SpectrumValue {
  std::vector<double> constant;                          ///< by wavelength; empty: an image
  const TextureDescription* image = nullptr;             ///< whose texels are written; nullptr: a constant
  std::shared_ptr<const SpectrumTexture> map = nullptr;  ///< of the parameter
};
struct FloatValue {
  double constant = 0;
  const TextureDescription* image = nullptr;          ///< whose texels are written; nullptr: a constant
  std::shared_ptr<const FloatTexture> map = nullptr;  ///< of the parameter
};

/// Returns the value of a parameter. "scale" and "mix" of images with one mapping are an image with the texels of the
/// largest one. Other textures are reported (Context::report_unsupported) and replaced by their mean.
SpectrumValue spectrum_value(Context& context, const ParsedPlugin& plugin, const Params& p, std::string_view name);
FloatValue float_value(Context& context, const ParsedPlugin& plugin, const Params& p, std::string_view name);

/// Writes a value times `scale` as property `name`. Images become EXR files of frond's values at the texels.
void write_value(Context& context, Xml& xml, std::string_view name, const SpectrumValue& value, double scale = 1);
void write_value(Context& context, Xml& xml, std::string_view name, const FloatValue& value);
/// Writes the three channels of an image of normals, without conversion.
void write_normals(Context& context, Xml& xml, std::string_view name, const std::filesystem::path& file,
                   const Image& image);

/// Values of a colour at a point, by wavelength.
using ColorAt = std::function<std::vector<double>(const TexturePoint&)>;

/// Returns the image with the most texels of those that the textures of these parameters consist of; nullptr if there
/// is none, or, reported, if they have no image in Mitsuba.
const TextureDescription* common_image(Context& context, const ParsedPlugin& plugin, const Params& p,
                                       std::span<const std::string_view> names);
/// Writes the values at the texels of an image that `common_image` has returned.
void write_texels(Context& context, Xml& xml, std::string_view name, const TextureDescription& image,
                  const ColorAt& at);

/// Means over texture coordinates in [0, 1)^2, and over space.
double mean_of(const FloatTexture& texture);
std::vector<double> mean_of(const SpectrumTexture& texture, const Spectra& spectra);
std::vector<double> mean_over_uv(const ColorAt& at);

}  // namespace frond::mitsuba
