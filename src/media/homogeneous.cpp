#include "media/medium_params.h"
#include "spectra/check_range.h"
#include "spectra/color/substances.h"

namespace frond {
namespace {

/// Coefficients are in 1/unit; those of presets are in 1/mm, converted by "scale".
constexpr Param kHomogeneous[] = {
    kSigmaA,
    kSigmaS,
    kMediumScale,
    kMeanCosine,
    kMediumEmission,
    {.name = "Lescale", .kind = ParamKind::real, .default_value = 1.0, .range = kAtLeastZero, .doc = "Factor of Le."},
    {.name = "preset",
     .kind = ParamKind::string,
     .doc = "Substance that gives both coefficients, for a unit of 1 mm: \"Skin1\", \"Wholemilk\" and others. It "
            "gives the reduced scattering coefficient, (1 - g) sigma_s."}};

/// Returns the coefficients of a preset or of both spectra. Throws InputError if both are given.
Coefficients coefficients_of(const Params& p) {
  if (!p.given("preset")) return Coefficients(p);
  for (const std::string_view name : {"sigma_a", "sigma_s"})
    if (p.given(name)) fail(p.where(name), "\"{}\" and \"preset\" exclude each other", name);
  const auto [sigma_a, sigma_s] = substance_coefficients(p.string("preset"), p.where("preset"), "preset");
  return {sigma_a, sigma_s, p.real("scale")};
}

/// The same everywhere.
class Homogeneous final : public Medium {
 public:
  Homogeneous(const Params& p, const Transform&)
      : coefficients_(coefficients_of(p)),
        emission_(p.given("Le") ? p.spectrum("Le") : nullptr),
        emission_scale_(float(p.real("Lescale"))),
        phase_(Phase::henyey_greenstein(float(p.real("g")))) {
    if (p.given("preset")) preset_where_ = p.where("preset");
  }

  MediumPoint properties(const Vec3&, const SampledWavelengths& lambda) const override {
    MediumPoint point{coefficients_.sigma_a(lambda), coefficients_.sigma_s(lambda), {}, phase_};
    if (emission_) point.emission = point.sigma_a * emission_->sample(lambda) * emission_scale_;
    return point;
  }
  MajorantSteps majorants(const Ray& ray, const SampledWavelengths& lambda) const override {
    // The majorant is the extinction coefficient itself: there are no null collisions.
    return {0, ray.t_max, coefficients_.sigma_t(lambda)};
  }
  bool is_homogeneous() const override { return true; }
  bool is_emissive() const override { return emission_ && emission_scale_ > 0; }
  void check(const WavelengthStrategy& wavelengths) const override {
    // Presets are RGB, whose spectra are defined over the CIE range only.
    if (preset_where_) check_range(kSubstanceRange_nm, wavelengths, *preset_where_, "preset");
  }

 private:
  Coefficients coefficients_;
  SpectrumPtr emission_;
  float emission_scale_;
  Phase phase_;
  std::optional<Location> preset_where_;  ///< set if the coefficients are a preset's
};

/// Leaf area density is in m2/m3 if the scene's unit is the metre.
constexpr Param kTurbid[] = {
    {.name = "density",
     .kind = ParamKind::real,
     .default_value = 1.0,
     .unit = "1/unit",
     .range = kAtLeastZero,
     .doc = "Leaf area density: one-sided leaf area for each unit of volume."},
    {.name = "reflectance", .kind = ParamKind::albedo, .default_value = 0.5, .doc = "Reflectance of the leaves."},
    {.name = "transmittance", .kind = ParamKind::albedo, .default_value = 0.0, .doc = "Transmittance of the leaves."}};

/// Leaves of vanishing size, whose normals point in all directions alike: a ray sees half of the leaf area.
class Turbid final : public Medium {
 public:
  Turbid(const Params& p, const Transform&)
      : reflectance_(p.spectrum("reflectance")),
        transmittance_(p.spectrum("transmittance")),
        extinction_(kShareSeen * float(p.real("density"))) {
    if (reflectance_->max_value() + transmittance_->max_value() > 1)
      p.warn("transmittance", "where reflectance and transmittance sum to more than 1, both are scaled to a sum of 1");
  }

  MediumPoint properties(const Vec3&, const SampledWavelengths& lambda) const override {
    MediumPoint point;
    SampledSpectrum share;
    const SampledSpectrum r = reflectance_->sample(lambda), t = transmittance_->sample(lambda);
    for (int i = 0; i < lambda.count; ++i) {
      // Single scattering albedo of a leaf: reflectance plus transmittance (Ross 1981).
      const float albedo = std::min(1.f, r[i] + t[i]);
      point.sigma_a[i] = extinction_ * (1 - albedo), point.sigma_s[i] = extinction_ * albedo;
      share[i] = albedo > 0 ? r[i] / (r[i] + t[i]) : 0;
    }
    point.phase = Phase::bi_lambertian(share);
    return point;
  }
  MajorantSteps majorants(const Ray& ray, const SampledWavelengths& lambda) const override {
    SampledSpectrum sigma;
    for (int i = 0; i < lambda.count; ++i) sigma[i] = extinction_;
    return {0, ray.t_max, sigma};
  }
  bool is_homogeneous() const override { return true; }

 private:
  static constexpr float kShareSeen = 0.5f;  ///< G of spherical leaf angles
  SpectrumPtr reflectance_, transmittance_;
  float extinction_;  ///< G times leaf area density, 1/unit; independent of direction and wavelength
};

}  // namespace

extern const MediumInfo homogeneous_medium{
    {"medium", "homogeneous", "Medium that is the same everywhere.", "pbrt-v4", kHomogeneous},
    make_medium<Homogeneous>};
extern const MediumInfo turbid_medium{
    {"medium", "turbid", "Turbid medium: bi-Lambertian leaves of vanishing size in all directions alike.", "Ross 1981",
     kTurbid},
    make_medium<Turbid>};

}  // namespace frond
