#include <map>

#include "core/parallel.h"
#include "media/medium_params.h"
#include "media/null_collisions.h"
#include "media/sampled_grid.h"
#include "spectra/analytic.h"
#include "spectra/check_range.h"
#include "spectra/cie.h"
#include "spectra/color/reflectance_table.h"

namespace frond {
namespace {

constexpr int kMajorantCells = 16;  // along each axis, as in pbrt-v4

/// Coefficients are in 1/unit, temperatures in kelvin after offset and scale; densities have no unit.
constexpr Param kUniformGrid[] = {
    kGridX,
    kGridY,
    kGridZ,
    kBoxLow,
    kBoxHigh,
    {.name = "density",
     .kind = ParamKind::real,
     .range = kAtLeastZero,
     .doc = "Densities at the centres of the cells, x fastest, then y, then z.",
     .list = true,
     .required = true},
    kSigmaA,
    kSigmaS,
    kMediumScale,
    kMeanCosine,
    kMediumEmission,
    {.name = "Lescale",
     .kind = ParamKind::real,
     .range = kAtLeastZero,
     .doc = "Factors of the emission at the same places. Without them: 1 in the middle of the box, falling to half at "
            "its faces, as in pbrt-v4.",
     .list = true},
    {.name = "temperature",
     .kind = ParamKind::real,
     .unit = "K",
     .doc = "Temperatures at the same places, for emission as a blackbody whose largest value is 1.",
     .list = true},
    kTemperatureOffset,
    kTemperatureScale,
    kTemperatureCutoff};

/// Returns the grid of a list of nx ny nz numbers. Throws InputError if their number differs.
SampledGrid<float> grid_of(const Params& p, std::string_view name) {
  const auto n = grid_size(p, name);
  const std::vector<double> values = p.reals(name);
  return {{values.begin(), values.end()}, n};
}
/// As grid_of; nullopt if the parameter is not given.
std::optional<SampledGrid<float>> optional_grid(const Params& p, std::string_view name) {
  return p.given(name) ? std::optional(grid_of(p, name)) : std::nullopt;
}

/// Density and emission on a grid, with the same spectra everywhere.
class UniformGrid final : public Medium {
 public:
  /// Throws InputError for both kinds of emission, an empty box, or lists that do not fit the grid.
  UniformGrid(const Params& p, const Transform& world_from_medium)
      : box_(medium_box(p, world_from_medium)),
        null_collisions_(box_.bounds(), world_from_medium, p.where()),
        coefficients_(p),
        phase_(Phase::henyey_greenstein(float(p.real("g")))),
        density_(grid_of(p, "density")),
        emission_scale_(p.given("Lescale") ? grid_of(p, "Lescale") : SampledGrid<float>({1.f}, {1, 1, 1})),
        temperatures_(optional_grid(p, "temperature")),
        temperature_(p),
        emission_(p.given("Le") ? p.spectrum("Le") : nullptr) {
    if (emission_ && temperatures_) fail(p.where("Le"), "\"Le\" and \"temperature\" exclude each other");
    density_.fill_majorants(majorants_, [](float v) { return v; });
  }

  /// Coefficients in 1/unit, interpolated trilinearly in the density (pbrt 4th ed., 11.4.4).
  MediumPoint properties(const Vec3& p, const SampledWavelengths& lambda) const override {
    const Vec3 unit = box_.world_to_unit(p);
    const float density = density_.at(unit);
    MediumPoint point{coefficients_.sigma_a(lambda) * density, coefficients_.sigma_s(lambda) * density, {}, phase_};
    // Both emissions are multiplied by the absorption coefficient: by Kirchhoff's law a medium emits where it absorbs.
    if (temperatures_)
      point.emission = temperature_.emission(temperatures_->at(unit), lambda);
    else if (emission_)
      point.emission = emission_->sample(lambda);
    point.emission *= point.sigma_a * emission_scale_.at(unit);
    return point;
  }
  /// Majorants of a 16^3 grid: the extinction coefficient of density 1 times the largest density of each cell.
  MajorantSteps majorants(const Ray& ray, const SampledWavelengths& lambda) const override {
    return box_.steps(ray, &majorants_, coefficients_.sigma_t(lambda));
  }
  bool is_emissive() const override { return emission_ || temperatures_; }
  void check(const WavelengthStrategy& wavelengths) const override { null_collisions_.check(*this, wavelengths); }

 private:
  MediumBox box_;
  NullCollisionCheck null_collisions_;
  Coefficients coefficients_;
  Phase phase_;
  SampledGrid<float> density_, emission_scale_;     ///< without unit
  std::optional<SampledGrid<float>> temperatures_;  ///< before offset and scale
  Temperature temperature_;
  SpectrumPtr emission_;  ///< of luminance 1; null: no emission, or thermal emission
  MajorantGrid majorants_{kMajorantCells};
};

/// As pbrt-v4's "rgbgrid" (pbrt 4th ed., 11.4.5). Colours are fitted by smooth spectra, which may exceed 1.
constexpr Param kRgbGrid[] = {
    kGridX,
    kGridY,
    kGridZ,
    kBoxLow,
    kBoxHigh,
    {.name = "sigma_a",
     .kind = ParamKind::rgb,
     .unit = "1/unit",
     .range = kAtLeastZero,
     .doc = "Absorption coefficients at the centres of the cells, x fastest, then y, then z; not given: 1.",
     .list = true},
    {.name = "sigma_s",
     .kind = ParamKind::rgb,
     .unit = "1/unit",
     .range = kAtLeastZero,
     .doc = "Scattering coefficients at the same places; not given: 1.",
     .list = true},
    kMediumScale,
    kMeanCosine,
    {.name = "Le",
     .kind = ParamKind::rgb,
     .range = kAtLeastZero,
     .doc = "Emission at the same places, not normalised: the luminance of white (1, 1, 1) is 106.9, as in pbrt-v4.",
     .list = true},
    {.name = "Lescale", .kind = ParamKind::real, .default_value = 1.0, .range = kAtLeastZero, .doc = "Factor of Le."}};

/// Grid of colours as spectra.
class ColorGrid {
 public:
  /// Throws InputError if the number of colours is not nx ny nz, or no spectrum has one of the colours.
  ColorGrid(const Params& p, std::string_view name)
      : name_(name),
        where_(p.where(name)),
        grid_(colors_of(p.vec3s(name), p.color_space(name), where_), grid_size(p, name, 3)) {}
  /// Throws InputError if colours are not defined at the wavelengths.
  void check(const WavelengthStrategy& wavelengths) const { check_range(kCieRange_nm, wavelengths, where_, name_); }
  /// Returns the spectrum at a position of the unit cube, interpolated between the spectra of the cells.
  SampledSpectrum at(const Vec3& unit, const SampledWavelengths& lambda) const {
    return grid_.at(unit, [&lambda](const Color& c) {
      SampledSpectrum s;
      if (c.scale > 0)
        for (int i = 0; i < lambda.count; ++i) s[i] = c.scale * c.reflectance.at(lambda.nm[size_t(i)]);
      return s;
    });
  }
  /// Raises the majorants to the largest value of each colour's spectrum over all wavelengths.
  void fill_majorants(MajorantGrid& majorants) const {
    grid_.fill_majorants(majorants, [](const Color& c) { return c.scale * c.reflectance.max_value(); });
  }

 private:
  /// The spectrum is the product of a reflectance, 0 to 1, and a scale; scale 0: black.
  struct Color {
    SigmoidPolynomial reflectance{{0, 0, 0}};
    float scale = 0;
  };

  /// Distinct colours are fitted; if there are many, they are interpolated in a table, except those that are purer than
  /// the table is exact for. Throws InputError for a colour that no spectrum has.
  static std::vector<Color> colors_of(const std::vector<Vec3>& rgb, const std::string& space_name,
                                      const Location& where) {
    // A fit takes far longer than a lookup in the table; most grids have few distinct colours.
    constexpr size_t kMostFits = 10000;
    const ColorSpace& space = color_space(space_name.empty() ? "srgb" : space_name, where);
    std::map<std::array<float, 3>, Color> known;
    std::optional<ReflectanceTable> table;
    std::vector<Color> colors;
    colors.reserve(rgb.size());
    for (const Vec3& c : rgb) {
      check_stop();
      Color& color = known[{c.x, c.y, c.z}];
      if (color.scale == 0 && std::max({c.x, c.y, c.z}) > 0) {
        if (known.size() > kMostFits && !table) table.emplace(space);
        color = color_of(c, space, table, where);
      }
      colors.push_back(color);
    }
    return colors;
  }
  /// Looks a colour up in the table, if there is one and its error is small enough; else fits it.
  static Color color_of(const Vec3& c, const ColorSpace& space, const std::optional<ReflectanceTable>& table,
                        const Location& where) {
    if (table) {
      constexpr float kRoom = 2;  // as in fit_scaled
      const float scale = kRoom * std::max({c.x, c.y, c.z});
      const Vec3 share = c / scale;
      const SigmoidPolynomial known = table->at(Float4{share.x, share.y, share.z, 0});
      const Triple target{double(share.x), double(share.y), double(share.z)};
      if (double(kRoom) * reflectance_error(space, target, known) <= kLargestFitError) return {known, scale};
    }
    const ScaledReflectance fit = fit_scaled(space, {double(c.x), double(c.y), double(c.z)}, where);
    return {fit.reflectance, float(fit.scale)};
  }

  std::string name_;
  Location where_;
  SampledGrid<Color> grid_;
};

/// Returns the grid of a parameter; nullopt if it is not given.
std::optional<ColorGrid> optional_colors(const Params& p, std::string_view name) {
  return p.given(name) ? std::optional<ColorGrid>(std::in_place, p, name) : std::nullopt;
}

/// Coefficients and emission as colours on a grid.
class RgbGrid final : public Medium {
 public:
  /// Throws InputError if both coefficients are missing, or if there is emission but no absorption.
  RgbGrid(const Params& p, const Transform& world_from_medium)
      : box_(medium_box(p, world_from_medium)),
        null_collisions_(box_.bounds(), world_from_medium, p.where()),
        phase_(Phase::henyey_greenstein(float(p.real("g")))),
        scale_(float(p.real("scale"))),
        // pbrt-v4 does not divide this emission by the integral of ybar.
        emission_scale_(float(p.real("Lescale") * photometric(ConstantSpectrum(1, kCieRange_nm)))),
        sigma_a_(optional_colors(p, "sigma_a")),
        sigma_s_(optional_colors(p, "sigma_s")),
        emission_(optional_colors(p, "Le")),
        white_(unit_d65()) {
    if (!sigma_a_ && !sigma_s_) fail(p.where(), "medium \"rgbgrid\" needs \"rgb sigma_a\" or \"rgb sigma_s\"");
    if (emission_ && !sigma_a_) fail(p.where("Le"), "\"Le\" needs \"rgb sigma_a\": the medium emits sigma_a Le");
    if (sigma_a_) sigma_a_->fill_majorants(of_absorption_);
    if (sigma_s_) sigma_s_->fill_majorants(of_scattering_);
    // The bound of a sum is the sum of the bounds; a coefficient that is not given is 1 in the whole box.
    std::array<int, 3> c;
    constexpr float kCell = 1 / float(kMajorantCells);
    for (c[2] = 0; c[2] < kMajorantCells; ++c[2])
      for (c[1] = 0; c[1] < kMajorantCells; ++c[1])
        for (c[0] = 0; c[0] < kMajorantCells; ++c[0]) {
          const Vec3 middle = Vec3{float(c[0]) + 0.5f, float(c[1]) + 0.5f, float(c[2]) + 0.5f} * kCell;
          const float sum = (sigma_a_ ? of_absorption_.at(c) : 1) + (sigma_s_ ? of_scattering_.at(c) : 1);
          majorants_.raise_bound(middle, middle, scale_ * sum);
        }
  }

  MediumPoint properties(const Vec3& p, const SampledWavelengths& lambda) const override {
    const Vec3 unit = box_.world_to_unit(p);
    // Only lanes in use are 1, so that coefficients and majorants agree in unused lanes, where both are 0.
    const auto in_use = [&lambda] {
      SampledSpectrum s;
      for (int i = 0; i < lambda.count; ++i) s[i] = 1;
      return s;
    };
    MediumPoint point{(sigma_a_ ? sigma_a_->at(unit, lambda) : in_use()) * scale_,
                      (sigma_s_ ? sigma_s_->at(unit, lambda) : in_use()) * scale_,
                      {},
                      phase_};
    if (is_emissive())
      point.emission = point.sigma_a * emission_->at(unit, lambda) * white_->sample(lambda) * emission_scale_;
    return point;
  }
  MajorantSteps majorants(const Ray& ray, const SampledWavelengths& lambda) const override {
    // The grid holds extinction coefficients, with the scale; they bound all wavelengths.
    SampledSpectrum one;
    for (int i = 0; i < lambda.count; ++i) one[i] = 1;
    return box_.steps(ray, &majorants_, one);
  }
  bool is_emissive() const override { return emission_ && emission_scale_ > 0; }
  void check(const WavelengthStrategy& wavelengths) const override {
    for (const std::optional<ColorGrid>* grid : {&sigma_a_, &sigma_s_, &emission_})
      if (*grid) (*grid)->check(wavelengths);
    null_collisions_.check(*this, wavelengths);
  }

 private:
  MediumBox box_;
  NullCollisionCheck null_collisions_;
  Phase phase_;
  float scale_, emission_scale_;  ///< of coefficients; of the emission, with pbrt-v4's photometric factor
  std::optional<ColorGrid> sigma_a_, sigma_s_, emission_;
  SpectrumPtr white_;  ///< CIE D65, illuminant of the colour space sRGB
  MajorantGrid of_absorption_{kMajorantCells}, of_scattering_{kMajorantCells}, majorants_{kMajorantCells};
};

}  // namespace

extern const MediumInfo uniform_grid_medium{
    {"medium", "uniformgrid", "Medium whose density is given on a grid.", "pbrt-v4", kUniformGrid},
    make_medium<UniformGrid>};
extern const MediumInfo rgb_grid_medium{
    {"medium", "rgbgrid", "Medium whose coefficients are colours on a grid.", "pbrt-v4", kRgbGrid},
    make_medium<RgbGrid>};

}  // namespace frond
