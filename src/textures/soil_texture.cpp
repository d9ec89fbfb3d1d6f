#include <algorithm>

#include "core/error.h"
#include "core/texture.h"
#include "spectra/soil.h"

namespace frond {
namespace {

/// Choices of "soil", in the order of kSoils.
constexpr auto kSoilNames = [] {
  std::array<std::string_view, std::size(kSoils)> names;
  for (size_t i = 0; i < names.size(); ++i) names[i] = kSoils[i].name;
  return names;
}();

constexpr Param kSoilParams[] = {
    {.name = "soil",
     .kind = ParamKind::string,
     .default_value = "dry_clay",
     .doc = "Soil of Jiang and Fang (2019), table 3.",
     .choices = kSoilNames},
    {.name = "coefficients",
     .kind = ParamKind::real,
     .doc = "Coefficients of their four General Spectral Vectors (three dry ones, moisture) in place of a soil's.",
     .list = true},
    {.name = "reflectance",
     .kind = ParamKind::albedo,
     .doc = "Measured reflectance of the dry soil in place of a soil's; linear between values every 10 nm."},
    {.name = "moisture",
     .kind = ParamKind::float_texture,
     .default_value = 0.0,
     .unit = "% of the volume",
     .range = {0, Soil::kMoisture.max},
     .doc = "Water in the soil, films of which darken it (BSM, Verhoef et al. 2018); none up to 5 %.",
     .quantity = PhysicalQuantity::soil_moisture}};

/// Returns the soil of the one source given. Throws InputError if two are given or a list has the wrong length.
Soil make_soil(const Params& p) {
  constexpr std::string_view kSources[] = {"soil", "coefficients", "reflectance"};
  std::string_view source = kSources[0], first;
  for (const std::string_view name : kSources)
    if (p.given(name)) {
      if (!first.empty()) fail(p.where(name), "\"{}\" and \"{}\" exclude each other", first, name);
      first = source = name;
    }
  if (source == "reflectance") return Soil(*p.spectrum("reflectance"));
  Soil::Coefficients c;
  if (source == "soil") {
    c = std::ranges::find(kSoils, p.string("soil"), &NamedSoil::name)->coefficients;
  } else {
    const auto given = p.reals("coefficients");
    if (given.size() != c.size())
      fail(p.where("coefficients"), "\"coefficients\" needs {} values and has {}", c.size(), given.size());
    std::ranges::copy(given, c.begin());
  }
  return Soil(c);
}

/// Reflectance of bare soil, dry or wet.
class SoilTexture final : public SpectrumTexture {
 public:
  SoilTexture(const Params& p, const TexturePlacement&)
      : soil_(make_soil(p)),
        range_nm_(p.given("reflectance") ? p.spectrum("reflectance")->range_nm() : Soil::kRange_nm),
        moisture_(p.float_texture("moisture")) {}
  /// Reflectance, 0 to 1, with moisture in % of the volume.
  SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const override {
    const float moisture = moisture_->evaluate(at);
    SampledSpectrum reflectance;
    for (int i = 0; i < lambda.count; ++i) reflectance[i] = soil_.reflectance(lambda.nm[size_t(i)], moisture);
    return reflectance;
  }
  Interval range_nm() const override { return range_nm_; }
  float max_value() const override { return soil_.max_reflectance(); }

 private:
  Soil soil_;
  Interval range_nm_;  ///< of the data, nm
  std::shared_ptr<const FloatTexture> moisture_;
};

std::unique_ptr<SpectrumTexture> make_soil(const Params& p, const TexturePlacement& placement) {
  return std::make_unique<SoilTexture>(p, placement);
}

}  // namespace

extern const SpectrumTextureInfo soil_spectrum_texture{
    {"spectrum texture", "soil", "Reflectance of bare soil, dry or wet.", "Jiang and Fang 2019, Verhoef et al. 2018",
     kSoilParams},
    make_soil};

}  // namespace frond
