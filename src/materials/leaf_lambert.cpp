#include <numbers>

#include "core/material.h"
#include "leaf/solve/quadrature.h"
#include "leaf/solve/side_curves.h"
#include "leaf/table/depth_table.h"
#include "leaf/table/table_axes.h"
#include "leaf/table/table_cache.h"
#include "materials/leaf_fluorescence.h"
#include "materials/leaf_params.h"
#include "materials/lobes/active_lanes.h"
#include "materials/lobes/two_sided_lambertian.h"
#include "materials/table_file_param.h"
#include "materials/table_wavelengths.h"

namespace frond {
namespace {

constexpr Param kOwnLeafLambertParams[] = {
    {.name = "incidence",
     .kind = ParamKind::real,
     .default_value = 8.0,
     .unit = "degrees",
     .range = {0, 89},
     .doc =
         "Angle of incidence whose reflectance and transmittance are used at all angles; 8 is that of an integrating "
         "sphere.",
     .quantity = PhysicalQuantity::angle},
    {.name = "bihemispherical",
     .kind = ParamKind::boolean,
     .default_value = false,
     .doc = "Use the means under diffuse light, over all angles of incidence, instead of one angle's values."},
    kTableFile,
    kTableLeaf,
};
const std::vector<Param> kLeafLambert = with_leaf_params(kOwnLeafLambertParams);

/// An angle of incidence, and its weight in the mean of a side.
struct Incidence {
  double theta_deg, weight;
};

/// Returns the angles in ascending order: `incidence`, or the nodes of the mean under diffuse light. The mean of a
/// share S, 2 int S(theta) cos theta sin theta dtheta, is the integral of 2 mu S(mu) over mu = cos theta in [0, 1]: S
/// is smooth in mu up to grazing, so Gauss's rule converges fast; with eight points the tests hold the specimens to
/// 2e-5, and leaves with any cuticle to 2e-4.
std::vector<Incidence> incidences(const Params& p) {
  if (!p.boolean("bihemispherical")) return {{p.real("incidence"), 1}};
  if (p.given("incidence"))
    fail(p.where("incidence"), "\"incidence\" has no effect with \"bihemispherical\": leave one of them out");
  std::vector<Incidence> result;
  for (const auto& [mu, weight] : leaf::gauss_legendre(8))
    result.push_back({std::acos(mu) * 180 / std::numbers::pi, 2 * mu * weight});
  std::ranges::reverse(result);
  return result;
}

/// Shares of both sides at one wavelength.
struct alignas(16) TwoSides {
  float front_reflected, front_transmitted, back_reflected, back_transmitted;

  SampledSpectrum as_vector() const {
    return SampledSpectrum(Float4{front_reflected, front_transmitted, back_reflected, back_transmitted});
  }
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

/// Shares of both sides in columns [wavelength], or [wavelength][depth] where the leaf's optical depth varies.
class TwoSidedSpectra {
 public:
  TwoSidedSpectra() = default;
  /// `fixed_lanes`: the wavelengths are the lanes; else they ascend and are at least two. `depths` may be empty.
  TwoSidedSpectra(const std::vector<double>& nm, leaf::DepthAxis depths, std::vector<TwoSides> columns,
                  bool fixed_lanes)
      : depths_(std::move(depths)), columns_(std::move(columns)) {
    if (!fixed_lanes) wavelengths_ = leaf::WavelengthAxis(nm);
  }

  /// At the leaf's optical depth in each lane, if that varies.
  std::array<SideShares, 2> at(const SampledWavelengths& lambda, const std::array<double, kLanes>& depth) const {
    return sum(lambda, leaf::select_columns(wavelengths_, depths_, lambda, depth));
  }
  std::array<SideShares, 2> at(const SampledWavelengths& lambda) const {
    return sum(lambda, leaf::select_columns(wavelengths_, lambda));
  }

 private:
  /// Lanes that are not active hold 0.
  std::array<SideShares, 2> sum(const SampledWavelengths& lambda, const leaf::TableSelection& selection) const {
    std::array<SideShares, 2> sides;
    for (int lane = 0; lane < selection.lane_count; ++lane) {
      if (!lambda.is_active(lane)) continue;
      const leaf::TableSelection::Lane& at = selection.lanes[static_cast<size_t>(lane)];
      SampledSpectrum shares;  // in the order of TwoSides
      for (size_t i = 0; i < static_cast<size_t>(selection.columns_per_lane); ++i)
        shares += columns_[at.column[i]].as_vector() * at.weight[i];
      sides[0].reflected[lane] = shares[0];
      sides[0].transmitted[lane] = shares[1];
      sides[1].reflected[lane] = shares[2];
      sides[1].transmitted[lane] = shares[3];
    }
    return sides;
  }

  leaf::WavelengthAxis wavelengths_;  ///< empty: lanes are wavelengths
  leaf::DepthAxis depths_;            ///< empty: the depth does not vary
  std::vector<TwoSides> columns_;
};

/// A Lambertian leaf, as in models of plant canopies: a reflectance and a transmittance for each side and wavelength.
class LeafLambert final : public Material, public FluorescentMaterial {
 public:
  explicit LeafLambert(const Params& p)
      : leaf_(p, LeafParams::Plates::table),
        varies_(!leaf_.depth().is_constant() && !p.given("tablefile")),
        incidences_(incidences(p)),
        file_(p, {}) {
    table_of_file_ = file_.read(p, 0);
    if (!table_of_file_) leaf_.reject_wall_textures(p);
  }

  void prepare(const Preparation& preparation) override {
    file_.warn(preparation.log);
    // Materials of one leaf and one set of wavelengths share their spectra.
    const std::string how =
        fmt::format("{}, {} incidences from {}, {}", leaf_.is_reciprocal() ? "reciprocal means" : "means",
                    incidences_.size(), incidences_[0].theta_deg, wavelengths_key(preparation.wavelengths));
    if (file_.is_given()) {
      spectra_ = preparation.share<TwoSidedSpectra>(how + file_.key(), [&] { return spectra_from_file(preparation); });
      return;
    }
    leaf_.check_wavelengths(preparation.wavelengths);
    if (varies_) {
      spectra_ = std::make_shared<const TwoSidedSpectra>(spectra_over_depth(preparation));
      return;
    }
    const leaf::TableRequest request = request_for(preparation.wavelengths);
    spectra_ = preparation.share<TwoSidedSpectra>(how + leaf::describe(request), [&] {
      return means(
          leaf::cached_table(request, leaf_.specimen(), preparation.pool, preparation.log, preparation.cache_dir),
          preparation);
    });
  }

  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const auto [front, back] = varies_ ? spectra_->at(lambda, leaf_.depth().at(hit.at, lambda)) : spectra_->at(lambda);
    return arena.make<TwoSidedLambertianBsdf>(front, back, leaf_.incident() == Incident::light);
  }

  bool is_reciprocal() const override { return leaf_.is_reciprocal(); }

  std::shared_ptr<const Fluorescence> fluorescence(const Preparation& preparation) const override {
    return only_matrix_fluorescence(leaf_, preparation.log);
  }

 private:
  // Angles of the adaxial side, then of the abaxial side in reverse, so that they ascend; a unifacial leaf is
  // symmetric. Shares are needed at these few angles only, so tables are small.
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

  TwoSidedSpectra spectra_from_file(const Preparation& preparation) const {
    const leaf::Table& table = *table_of_file_;
    return means(leaf::at_wavelengths(table, file_wavelengths(table.wavelengths_nm, preparation.wavelengths,
                                                              file_.where(), file_.name())),
                 preparation);
  }

  /// For a leaf whose chemistry or thickness varies; not cached on disk.
  TwoSidedSpectra spectra_over_depth(const Preparation& preparation) const {
    const leaf::TableRequest request = request_for(preparation.wavelengths);
    const leaf::DepthTable table = leaf::make_depth_table(
        leaf::TissueModel(request.params), request.theta_deg, index_wavelengths(preparation.wavelengths),
        depth_axis(leaf_.depth(), preparation.wavelengths, kSharesDepthStep), preparation.pool);
    return {table.wavelengths_nm, table.depths, means(table.theta_deg, table.shares), has_fixed_lanes(preparation)};
  }

  TwoSidedSpectra means(const leaf::Table& table, const Preparation& preparation) const {
    return {table.wavelengths_nm, {}, means(table.theta_deg, table.shares), has_fixed_lanes(preparation)};
  }

  static bool has_fixed_lanes(const Preparation& preparation) { return !preparation.wavelengths.fixed_nm().empty(); }

  /// Means of columns [column][angle].
  std::vector<TwoSides> means(const std::vector<double>& theta_deg, std::span<const leaf::Shares> shares) const {
    std::vector<TwoSides> columns;
    for (size_t first = 0; first < shares.size(); first += theta_deg.size()) {
      const auto column = shares.subspan(first, theta_deg.size());
      const leaf::Shares front = mean({theta_deg, column, false}), back = mean({theta_deg, column, true});
      const TwoSides sides{float(front.subsurface), float(front.transmitted), float(back.subsurface),
                           float(back.transmitted)};
      columns.push_back(leaf_.is_reciprocal() ? make_reciprocal(sides) : sides);
    }
    return columns;
  }

  /// Mean of one side; `subsurface` holds all reflected light.
  leaf::Shares mean(const leaf::SideCurves& side) const {
    leaf::Shares sum;
    for (const auto& [theta_deg, weight] : incidences_) {
      const leaf::Shares s = side.at(theta_deg);
      sum.subsurface += weight * (s.surface + s.subsurface);
      sum.transmitted += weight * s.transmitted;
    }
    return sum;
  }

  LeafParams leaf_;
  bool varies_;  ///< the optical depth varies over the leaf
  std::vector<Incidence> incidences_;
  TableFileParam file_;
  std::shared_ptr<const leaf::Table> table_of_file_;  ///< nullptr: no file is given
  std::shared_ptr<const TwoSidedSpectra> spectra_;
};

}  // namespace

extern const MaterialInfo leaf_lambert_material{
    {"material", "leaf_lambert", "Lambertian leaf: one reflectance and one transmittance for each side and wavelength.",
     "The models of plant canopies, such as Verhoef 1984 (SAIL)", kLeafLambert},
    make_material<LeafLambert>,
    LeafModel{.reference = "abm", .cost = 1, .table = LeafModel::Table::shares}};

}  // namespace frond
