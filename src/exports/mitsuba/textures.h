#pragma once

#include "exports/mitsuba/context.h"

namespace frond::mitsuba {

/// Value of a material's parameter: a constant or an image.
struct SpectrumValue {
  std::vector<double> constant;                ///< by wavelength; empty: an image
  const TextureDescription* image = nullptr;   ///< nullptr: a constant
  std::shared_ptr<const SpectrumTexture> map;  ///< of the image
};
struct FloatValue {
  double constant = 0;
  const TextureDescription* image = nullptr;  ///< nullptr: a constant
  std::shared_ptr<const FloatTexture> map;    ///< of the image
};

/// Returns the value of a parameter. Throws InputError for textures other than "constant" and "imagemap".
SpectrumValue spectrum_value(Context& context, const ParsedPlugin& plugin, const Params& p, std::string_view name);
FloatValue float_value(Context& context, const ParsedPlugin& plugin, const Params& p, std::string_view name);

/// Writes a value times `scale` as property `name`. Images become EXR files of frond's values at the texels; in
/// spectral variants images of colours are refused.
void write_value(Context& context, Xml& xml, std::string_view name, const SpectrumValue& value, double scale = 1);
void write_value(Context& context, Xml& xml, std::string_view name, const FloatValue& value);

}  // namespace frond::mitsuba
