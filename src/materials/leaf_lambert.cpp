#include <numbers>

#include "core/material.h"
#include "leaf/solve/quadrature.h"
#include "leaf/table/table_axes.h"
#include "leaf/table/table_cache.h"
#include "materials/leaf_params.h"
#include "materials/lobes/active_lanes.h"
#include "materials/lobes/two_sided_lambertian.h"
#include "materials/table_wavelengths.h"

namespace frond {
namespace {

constexpr Param kOwn[] = {
    {.name = "incidence",
     .kind = ParamKind::real,
     .unit = "degrees",
     .range = {0, 89},
     .doc = "Angle of incidence whose reflectance and transmittance are used at all angles, such as 8 of an "
            "integrating sphere; by default the means under diffuse light."},
};
constexpr auto kLeafLambert = with_leaf_params(kOwn);

/// An angle of incidence, and its weight in the mean of a side.
struct Incidence {
  double theta_deg, weight;
};

/// Returns the angles in ascending order. The mean of a share S under diffuse light, 2 int S(theta) cos theta sin theta
/// dtheta, is that of 2 mu S(mu) over mu = cos theta in [0, 1]: S is smooth in mu up to grazing, so Gauss's rule
/// converges fast; with eight points the tests hold the specimens to 2e-5, and leaves with any cuticle to 2e-4.
std::vector<Incidence> incidences(const Params& p) {
  if (p.given("incidence")) return {{p.real("incidence"), 1}};
  std::vector<Incidence> result;
  for (const auto& [mu, weight] : leaf::gauss_legendre(8))
    result.push_back({std::acos(mu) * 180 / std::numbers::pi, 2 * mu * weight});
  std::ranges::reverse(result);
  return result;
}

/// Shares of both sides at one wavelength.
struct alignas(16) TwoSides {
  float front_reflected, front_transmitted, back_reflected, back_transmitted;
};

/// Returns the reciprocal leaf closest to `s`, as in leaf/table/reciprocal_modes.h, with one d for each side:
///   d_f (d_f R_f + d_b T) = R_f + T_f,   d_b (d_b R_b + d_f T) = R_b + T_b,   T = (T_f + T_b) / 2,
/// where d_f d_b solves a quadratic equation.
TwoSides make_reciprocal(const TwoSides& s) {
  const double front = double(s.front_reflected) + double(s.front_transmitted),
               back = double(s.back_reflected) + double(s.back_transmitted);
  const double through = (double(s.front_transmitted) + double(s.back_transmitted)) / 2;
  const double reflects = double(s.front_reflected) * double(s.back_reflected);
  const double b = through * (front + back), root = through * (front - back);
  // The smaller root of the quadratic equation, in the form without cancellation.
  const double denominator = b + std::sqrt(root * root + 4 * front * back * reflects);
  const double t = denominator > 0 ? 2 * front * back * through / denominator : 0;
  return {float(front - t), float(t), float(back - t), float(t)};
}

/// Shares of both sides by wavelength: lane by lane if the lanes are fixed, else linear in between.
class TwoSidedSpectra {
 public:
  TwoSidedSpectra() = default;
  /// `fixed_lanes`: the wavelengths are the lanes; else they ascend and are at least two.
  TwoSidedSpectra(const std::vector<double>& nm, std::vector<TwoSides> values, bool fixed_lanes)
      : values_(std::move(values)) {
    if (!fixed_lanes) axis_ = leaf::WavelengthAxis(nm);
  }

  /// Lanes that are not active hold 0.
  std::array<SideShares, 2> at(const SampledWavelengths& lambda) const {
    std::array<SideShares, 2> sides;
    for (int lane = 0; lane < lambda.count; ++lane) {
      if (!lambda.is_active(lane)) continue;
      const auto i = static_cast<size_t>(lane);
      const TwoSides s = axis_.empty() ? values_[i] : between(axis_.cell(lambda.nm[i]));
      sides[0].reflected[lane] = s.front_reflected;
      sides[0].transmitted[lane] = s.front_transmitted;
      sides[1].reflected[lane] = s.back_reflected;
      sides[1].transmitted[lane] = s.back_transmitted;
    }
    return sides;
  }

 private:
  TwoSides between(const leaf::AxisCell& cell) const {
    const float t = cell.t;
    const TwoSides &a = values_[cell.below], &b = values_[cell.below + 1];
    const auto blend = [&](float TwoSides::*value) { return a.*value * (1 - t) + b.*value * t; };
    return {blend(&TwoSides::front_reflected), blend(&TwoSides::front_transmitted), blend(&TwoSides::back_reflected),
            blend(&TwoSides::back_transmitted)};
  }

  leaf::WavelengthAxis axis_;  ///< empty: values are lanes
  std::vector<TwoSides> values_;
};

/// A Lambertian leaf, as in models of plant canopies: a reflectance and a transmittance for each side and wavelength.
class LeafLambert final : public Material {
 public:
  explicit LeafLambert(const Params& p) : leaf_(p), incidences_(incidences(p)) {
    // A texture would require a table at each point.
    if (!leaf_.is_constant())
      fail(p.where(),
           "leaf_lambert takes no textures: its parameters are those of the whole leaf; leaf_simplified and "
           "leaf_solved take "
           "them for "
           "chemistry, thickness and cuticle, abm for everything");
  }

  void prepare(const Preparation& preparation) override {
    leaf_.check_wavelengths(preparation.wavelengths);
    // Both means need shares at a few angles only, so the table is small.
    const leaf::TableRequest request = request_for(preparation.wavelengths);
    const auto make = [&] {
      const leaf::Table table =
          leaf::cached_table(request, leaf_.specimen(), preparation.pool, preparation.log, preparation.cache_dir);
      return means(table, !preparation.wavelengths.fixed_nm().empty());
    };
    // Materials of one leaf and one set of wavelengths share their spectra.
    const std::string what = leaf_.is_reciprocal() ? "reciprocal means, " : "means, ";
    spectra_ = preparation.share<TwoSidedSpectra>(
        what + wavelengths_key(preparation.wavelengths) + leaf::describe(request), make);
  }

  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    const auto [front, back] = spectra_->at(lambda);
    return arena.make<TwoSidedLambertianBsdf>(front, back, leaf_.incident() == Incident::light);
  }

  bool is_reciprocal() const override { return leaf_.is_reciprocal(); }
  bool is_leaf() const override { return true; }

 private:
  // Angles of the adaxial side, then of the abaxial side in reverse, so that they ascend; a unifacial leaf is
  // symmetric.
  leaf::TableRequest request_for(const WavelengthStrategy& wavelengths) const {
    leaf::TableRequest request;
    request.params = leaf_.tissue();
    request.params.cuticle_aspect = 0;  // no share depends on it: leaves with other cuticles share a table
    request.wavelengths_nm = table_wavelengths(wavelengths);
    request.theta_deg.clear();
    for (const Incidence& i : incidences_) request.theta_deg.push_back(i.theta_deg);
    if (request.params.structure == leaf::Structure::bifacial)
      for (auto i = incidences_.rbegin(); i != incidences_.rend(); ++i) request.theta_deg.push_back(180 - i->theta_deg);
    return request;
  }

  TwoSidedSpectra means(const leaf::Table& table, bool fixed_lanes) const {
    std::vector<TwoSides> values;
    for (size_t w = 0; w < table.wavelengths_nm.size(); ++w) {
      const leaf::Shares front = mean(table, w, false), back = mean(table, w, true);
      const TwoSides sides{float(front.subsurface), float(front.transmitted), float(back.subsurface),
                           float(back.transmitted)};
      values.push_back(leaf_.is_reciprocal() ? make_reciprocal(sides) : sides);
    }
    return {table.wavelengths_nm, std::move(values), fixed_lanes};
  }

  /// Mean of one side; `subsurface` holds all reflected light.
  leaf::Shares mean(const leaf::Table& table, size_t wavelength, bool back) const {
    leaf::Shares sum;
    for (size_t i = 0; i < incidences_.size(); ++i) {
      const bool mirrored = back && !table.has_equal_sides();
      const leaf::Shares& s = table.at(wavelength, mirrored ? table.theta_deg.size() - 1 - i : i);
      sum.subsurface += incidences_[i].weight * (s.surface + s.subsurface);
      sum.transmitted += incidences_[i].weight * s.transmitted;
    }
    return sum;
  }

  LeafParams leaf_;
  std::vector<Incidence> incidences_;
  std::shared_ptr<const TwoSidedSpectra> spectra_;
};

}  // namespace

extern const MaterialInfo leaf_lambert_material{
    {"material", "leaf_lambert", "Lambertian leaf: one reflectance and one transmittance for each side and wavelength.",
     "The models of plant canopies, such as Verhoef 1984 (SAIL)", kLeafLambert},
    make_material<LeafLambert>};

}  // namespace frond
