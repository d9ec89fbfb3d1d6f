#include <chrono>

#include "core/material.h"
#include "core/messages/counted.h"
#include "leaf/table/table_cache.h"
#include "materials/leaf_fluorescence.h"
#include "materials/leaf_params.h"
#include "materials/lobes/active_lanes.h"
#include "materials/lobes/three_lobe.h"
#include "materials/table_file_param.h"
#include "materials/table_wavelengths.h"

namespace frond {
namespace {

constexpr std::string_view kMethods[] = {"solve", "montecarlo"};
constexpr Param kOwnLeafSimplifiedParams[] = {
    {.name = "oblateness",
     .kind = ParamKind::real,
     .range = {0, 1000},
     .doc = "Exponent of the surface lobe; by default cuticleaspect, so that abm has the same surface."},
    {.name = "surfacedirect",
     .kind = ParamKind::boolean,
     .default_value = true,
     .doc = "Include the surface lobe in light sampling; false, as published: only rays drawn from it reach lights."},
    {.name = "tablemethod",
     .kind = ParamKind::string,
     .default_value = std::string_view("solve"),
     .doc = "Method for reflectance and transmittance. solve: without noise; montecarlo: random walks, as published.",
     .choices = kMethods},
    {.name = "tablerays",
     .kind = ParamKind::integer,
     .default_value = 1000000,
     .range = {1, 1e9},
     .doc = "Number of random walks for each angle of incidence, with montecarlo."},
    {.name = "tablestep",
     .kind = ParamKind::real,
     .default_value = 1.0,
     .unit = "degrees",
     .range = {0.1, 90},
     .doc = "Largest step between the table's angles of incidence; the widest that divides 90 degrees is used."},
    kTableFile,
    kTableLeaf,
    {.name = "tablesurface",
     .kind = ParamKind::real,
     .default_value = 0.04,
     .range = {0, 1},
     .doc =
         "Share of light that the surface lobe reflects, at most R, where tablefile holds measured R and T. It moves "
         "light from the diffuse lobe to the surface lobe: R stays as measured."},
};
const std::vector<Param> kLeafSimplified = with_leaf_params(kOwnLeafSimplifiedParams);

// Parameters that have no effect with "tablefile".
constexpr std::string_view kOfTable[] = {"tablemethod", "tablerays", "tablestep"};

/// Returns even angles that include 90 degrees. A unifacial leaf is symmetric and requires only one side.
std::vector<double> table_angles(const leaf::TissueParams& params, double most_step_deg) {
  constexpr double kRounding = 1e-6;  // tolerates steps such as 90 / 7, written in decimals
  const int steps = static_cast<int>(std::ceil(90 / most_step_deg - kRounding));
  std::vector<double> theta_deg;
  for (int i = 0; i <= (params.structure == leaf::Structure::unifacial ? steps : 2 * steps); ++i)
    theta_deg.push_back(90.0 * i / steps);
  return theta_deg;
}

leaf::TableLookup lookup_of(const leaf::Table& table, const WavelengthStrategy& strategy) {
  return strategy.fixed_nm().empty() ? leaf::TableLookup::for_spectra(table) : leaf::TableLookup::for_lanes(table);
}

// Material "leaf_simplified". The table comes from "tablefile", from a solution over optical depth if chemistry or
// thickness varies over the leaf, or else from the cache or a solution for the leaf's own depth.
class LeafSimplified final : public Material, public FluorescentMaterial {
 public:
  explicit LeafSimplified(const Params& p)
      : leaf_(p, LeafParams::Plates::table),
        varies_(!leaf_.depth().is_constant() && !p.given("tablefile")),
        surface_texture_(p.given("oblateness") ? nullptr : leaf_.cuticle_aspect()),
        exponent_(p.given("oblateness") ? p.real("oblateness") : leaf_.tissue().cuticle_aspect),
        manner_{p.boolean("surfacedirect"), leaf_.incident()},
        file_(p, kOfTable) {
    request_.params = leaf_.tissue();
    request_.theta_deg = table_angles(request_.params, p.real("tablestep"));
    if (p.string("tablemethod") == "montecarlo") request_.method = leaf::TableMethod::monte_carlo;
    // Leaves with other cuticles share a solved table. A table by walks depends on the cuticle's lobe through its
    // random numbers.
    if (request_.method == leaf::TableMethod::solve) request_.params.cuticle_aspect = 0;
    request_.rays = p.integer("tablerays");
    table_of_file_ = file_.read(p, p.real("tablesurface"));
    if (!table_of_file_) reject_textures(p);
  }

  void prepare(const Preparation& preparation) override {
    file_.warn(preparation.log);
    surface_ = preparation.share<leaf::CutLobe>(fmt::format("surface lobe {}", exponent_),
                                                [&] { return leaf::CutLobe(exponent_); });
    if (file_.is_given())
      lookup_ = preparation.share<leaf::TableLookup>(wavelengths_key(preparation.wavelengths) + file_.key(),
                                                     [&] { return read_lookup(preparation); });
    else if (varies_)
      lookup_ = std::make_shared<const leaf::TableLookup>(depth_lookup(preparation));
    else
      lookup_ =
          preparation.share<leaf::TableLookup>(key_of_request(preparation), [&] { return made_lookup(preparation); });
    fixed_ = varies_ ? leaf::TableSelection() : lookup_->select(preparation.wavelengths.sample(0));
    reciprocal_.reset();
    if (leaf_.is_reciprocal())
      reciprocal_ = std::make_shared<const leaf::ReciprocalLookup>(
          *lookup_, surface_texture_ ? surface_texture_->range() : Interval{exponent_, exponent_});
  }

  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    // Lobe and selection lie in the arena or in this material, which both outlive the BSDF.
    const leaf::Lobe* surface = surface_texture_
                                    ? arena.make<leaf::Lobe>(static_cast<double>(surface_texture_->evaluate(hit.at)))
                                    : surface_.get();
    LeafHit at{lookup_.get(), selection(hit, lambda, arena), surface, lane_mask(lambda)};
    if (reciprocal_) {
      at.reciprocal = reciprocal_.get();
      at.exponent = reciprocal_->position(static_cast<float>(surface->exponent()));
    }
    return arena.make<ThreeLobeBsdf>(at, manner_);
  }

  bool is_reciprocal() const override { return leaf_.is_reciprocal(); }

  std::shared_ptr<const Fluorescence> fluorescence(const Preparation& preparation) const override {
    return only_matrix_fluorescence(leaf_, preparation.log);
  }

 private:
  const leaf::TableSelection* selection(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const {
    if (varies_) return arena.make<leaf::TableSelection>(lookup_->select(lambda, leaf_.depth().at(hit.at, lambda)));
    return fixed_.lane_count == 0 ? &fixed_ : arena.make<leaf::TableSelection>(lookup_->select(lambda));
  }

  void reject_textures(const Params& p) const {
    leaf_.reject_wall_textures(p);
    // Only the solver shares its work between depths (leaf/solve/solver.h).
    if (varies_ && request_.method == leaf::TableMethod::monte_carlo)
      fail(p.where("tablemethod"),
           "tables of leaves whose chemistry or thickness varies are solved: leave "
           "\"tablemethod\" out");
  }

  /// Solves a table over depth for a leaf whose chemistry or thickness varies; not cached on disk.
  leaf::TableLookup depth_lookup(const Preparation& preparation) const {
    leaf_.check_wavelengths(preparation.wavelengths);
    const auto start = std::chrono::steady_clock::now();
    const bool fixed = !preparation.wavelengths.fixed_nm().empty();
    const std::vector<double> wavelengths = index_wavelengths(preparation.wavelengths);
    const leaf::DepthTable table =
        leaf::make_depth_table(leaf::TissueModel(request_.params), request_.theta_deg, wavelengths,
                               depth_axis(leaf_.depth(), preparation.wavelengths, kSharesDepthStep), preparation.pool);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    preparation.log.info(fmt::format(
        "leaf table: {}, {} x {} x {}, solve, {:.2g} s", leaf_.specimen(), counted(wavelengths.size(), "wavelength"),
        counted(table.depths.depths().size(), "depth"), counted(table.theta_deg.size(), "angle"), seconds.count()));
    return fixed ? leaf::TableLookup::for_lanes(table) : leaf::TableLookup::for_spectra(table);
  }

  leaf::TableRequest request_for(const WavelengthStrategy& wavelengths) const {
    leaf::TableRequest request = request_;
    request.wavelengths_nm = table_wavelengths(wavelengths);
    return request;
  }

  // Materials with equal keys share one look-up table.
  std::string key_of_request(const Preparation& preparation) const {
    return wavelengths_key(preparation.wavelengths) + leaf::describe(request_for(preparation.wavelengths));
  }

  // Computes the table, or reads it from the cache on disk.
  leaf::TableLookup made_lookup(const Preparation& preparation) const {
    leaf_.check_wavelengths(preparation.wavelengths);
    const leaf::Table table = leaf::cached_table(request_for(preparation.wavelengths), leaf_.specimen(),
                                                 preparation.pool, preparation.log, preparation.cache_dir);
    return lookup_of(table, preparation.wavelengths);
  }

  // The table of "tablefile".
  leaf::TableLookup read_lookup(const Preparation& preparation) const {
    const leaf::Table& table = *table_of_file_;
    preparation.log.info(
        fmt::format("leaf table: {}, {} x {}{}", file_.name(), counted(table.wavelengths_nm.size(), "wavelength"),
                    counted(table.theta_deg.size(), "angle"), table.has_equal_sides() ? ", both sides the same" : ""));
    return lookup_of(leaf::at_wavelengths(table, file_wavelengths(table.wavelengths_nm, preparation.wavelengths,
                                                                  file_.where(), file_.name())),
                     preparation.wavelengths);
  }

  LeafParams leaf_;
  bool varies_;  ///< the optical depth varies over the leaf
  leaf::TableRequest request_;
  std::shared_ptr<const leaf::TableLookup> lookup_;
  leaf::TableSelection fixed_;                                ///< of every path, if its lane_count is 0
  std::shared_ptr<const leaf::ReciprocalLookup> reciprocal_;  ///< nullptr: not reciprocal
  LeafParams::Aspect surface_texture_;                        ///< exponent of the surface's lobe; nullptr: constant
  double exponent_;                                           ///< of the surface's lobe if it is constant
  std::shared_ptr<const leaf::CutLobe> surface_;              ///< lobe with that exponent
  LeafManner manner_;
  TableFileParam file_;
  std::shared_ptr<const leaf::Table> table_of_file_;  ///< nullptr: no file is given
};

}  // namespace

extern const MaterialInfo leaf_simplified_material{
    {"material", "leaf_simplified", "Leaf as three lobes, scaled by a table of reflectance and transmittance.",
     "Baranoski and Rokne, A Simplified Model for Light Interaction with Plant Tissue", kLeafSimplified},
    make_material<LeafSimplified>,
    LeafModel{.reference = "abm", .cost = 1.07, .table = LeafModel::Table::shares}};

}  // namespace frond
