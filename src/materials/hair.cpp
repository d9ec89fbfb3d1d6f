#include "materials/lobes/hair.h"

#include "core/material.h"
#include "core/texture.h"
#include "materials/lobes/active_lanes.h"
#include "spectra/check_range.h"
#include "spectra/color/color_space.h"
#include "spectra/color/reflectance_table.h"
#include "spectra/wavelengths/fixed_wavelengths.h"

namespace frond {
namespace {

constexpr Param kHair[] = {
    {.name = "sigma_a",
     .kind = ParamKind::spectrum_texture,
     .unit = "1/radius",
     .range = kAtLeastZero,
     .doc = "Absorption coefficient (natural logarithm) inside the fibre, times its radius."},
    {.name = "reflectance",
     .kind = ParamKind::spectrum_texture,
     .range = {0, 1},
     .doc = "Colour of much hair under an even light, which determines sigma_a."},
    {.name = "color", .kind = ParamKind::spectrum_texture, .range = {0, 1}, .doc = "Another name of \"reflectance\"."},
    {.name = "eumelanin",
     .kind = ParamKind::float_texture,
     .range = kAtLeastZero,
     .doc = "Concentration of the brown pigment of hair; 1.3 if no other absorption is given."},
    {.name = "pheomelanin",
     .kind = ParamKind::float_texture,
     .range = kAtLeastZero,
     .doc = "Concentration of the reddish pigment of hair."},
    {.name = "eta",
     .kind = ParamKind::float_texture,
     .default_value = 1.55,
     .range = {1, 10},
     .doc = "Index of refraction inside the fibre over that outside."},
    {.name = "beta_m",
     .kind = ParamKind::float_texture,
     .default_value = 0.3,
     .range = {0, 1},
     .doc = "Roughness along the fibre; below 0.01 counts as 0.01."},
    {.name = "beta_n",
     .kind = ParamKind::float_texture,
     .default_value = 0.3,
     .range = {0, 1},
     .doc = "Roughness around the fibre; below 0.01 counts as 0.01."},
    {.name = "alpha",
     .kind = ParamKind::float_texture,
     .default_value = 2.0,
     .unit = "deg",
     .range = {-90, 90},
     .doc = "Angle between the scales of the surface and the axis of the fibre."},
};

/// Absorption of melanin of concentration 1, for a fibre of radius 1, as linear sRGB (pbrt-v4).
constexpr Float4 kEumelanin{0.419f, 0.697f, 1.37f, 0}, kPheomelanin{0.187f, 0.4f, 1.05f, 0};
constexpr double kBrown = 1.3;  ///< concentration of eumelanin by default

/// Absorption by melanin, whose colours are known as sRGB only.
class Melanin final : public SpectrumTexture {
 public:
  explicit Melanin(const Params& p)
      : eumelanin_(amount(p, "eumelanin", p.given("pheomelanin") ? 0 : kBrown)),
        pheomelanin_(amount(p, "pheomelanin", 0)),
        table_(ReflectanceTable::srgb()) {}

  SampledSpectrum evaluate(const TexturePoint& at, const SampledWavelengths& lambda) const override {
    const Float4 rgb = eumelanin_->evaluate(at) * kEumelanin + pheomelanin_->evaluate(at) * kPheomelanin;
    const float scale = 2 * std::max({rgb[0], rgb[1], rgb[2]});
    return scale > 0 ? table_.sample(rgb / scale, lambda) * scale : SampledSpectrum();
  }
  Interval range_nm() const override { return {360, 830}; }
  float max_value() const override { return std::numeric_limits<float>::infinity(); }

 private:
  static std::shared_ptr<const FloatTexture> amount(const Params& p, std::string_view name, double otherwise) {
    if (p.given(name)) return p.float_texture(name);
    return std::make_shared<ConstantFloatTexture>(float(otherwise));
  }
  std::shared_ptr<const FloatTexture> eumelanin_, pheomelanin_;
  const ReflectanceTable& table_;
};

// Material "hair": a fibre, which pbrt-v4's parameters describe. The offset of a ray from the fibre's axis is the
// texture coordinate v, on a curve and on any other shape.
class Hair final : public Material {
 public:
  explicit Hair(const Params& p)
      : eta_(p.float_texture("eta")),
        beta_m_(p.float_texture("beta_m")),
        beta_n_(p.float_texture("beta_n")),
        alpha_(p.float_texture("alpha")) {
    constexpr std::string_view kSources[] = {"sigma_a", "reflectance", "color", "eumelanin", "pheomelanin"};
    for (const std::string_view name : kSources)
      if (p.given(name) && source_.empty())
        source_ = name;
      else if (p.given(name) && !(source_ == "eumelanin" && name == "pheomelanin"))
        p.warn(name, fmt::format("\"{}\" has no effect beside \"{}\", as in pbrt-v4", name, source_));
    where_ = p.where(source_);
    is_color_ = source_ == "reflectance" || source_ == "color";
    const bool is_melanin = source_.empty() || source_.ends_with("melanin");
    absorption_ = is_melanin ? std::make_shared<Melanin>(p) : p.spectrum_texture(source_);
  }

  void prepare(const Preparation& preparation) override {
    const Interval needed_nm = preparation.wavelengths.range_nm(), known_nm = absorption_->range_nm();
    const bool is_melanin = source_.empty() || source_.ends_with("melanin");
    if (is_melanin && !(known_nm.contains(needed_nm.min) && known_nm.contains(needed_nm.max)))
      fail(where_,
           "melanin is known from {:g} to {:g} nm, the render needs {:g} to {:g} nm: give \"spectrum sigma_a\" or "
           "\"spectrum reflectance\"",
           known_nm.min, known_nm.max, needed_nm.min, needed_nm.max);
    check_range(known_nm, preparation.wavelengths, where_, source_);
  }

  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    constexpr float kSmoothest = 0.01f, kDegreeInRadians = kPi / 180;
    const FiberForm form{.offset = std::clamp(2 * hit.at.uv.y - 1, -1.f, 1.f),
                         .eta = eta_->evaluate(hit.at),
                         .beta_m = std::max(beta_m_->evaluate(hit.at), kSmoothest),
                         .beta_n = std::max(beta_n_->evaluate(hit.at), kSmoothest),
                         .tilt_radians = alpha_->evaluate(hit.at) * kDegreeInRadians};
    const SampledSpectrum mask = lane_mask(lambda), value = absorption_->evaluate(hit.at, lambda);
    return arena.make<HairBsdf>(form, is_color_ ? absorption_of_color(value, mask, form.beta_n) : value * mask, mask);
  }
  bool needs_details() const override { return true; }

 private:
  /// Absorption inside fibres of which many have this colour together: a fit of Chiang et al.
  static SampledSpectrum absorption_of_color(const SampledSpectrum& color, const SampledSpectrum& mask, float beta_n) {
    constexpr float kDarkest = 1e-6f;
    constexpr float kFit[] = {5.969f, -0.215f, 2.532f, -10.73f, 5.574f, 0.245f};
    float divisor = 0;
    for (size_t i = std::size(kFit); i-- > 0;) divisor = divisor * beta_n + kFit[i];
    SampledSpectrum root;
    for (int lane = 0; lane < kLanes; ++lane) root[lane] = std::log(std::clamp(color[lane], kDarkest, 1.f)) / divisor;
    return root * root * mask;
  }

  std::string_view source_;  ///< parameter that gives the absorption; empty: melanin by default
  Location where_;
  bool is_color_;
  std::shared_ptr<const SpectrumTexture> absorption_;
  std::shared_ptr<const FloatTexture> eta_, beta_m_, beta_n_, alpha_;
};

}  // namespace

extern const MaterialInfo hair_material{{"material", "hair", "Hair, awn, trichome or root: a dielectric fibre.",
                                         "Marschner et al. 2003; Chiang et al. 2016; pbrt-v4", kHair},
                                        make_material<Hair>};

}  // namespace frond
