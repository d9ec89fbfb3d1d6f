#include <optional>

#include "core/material.h"
#include "core/messages/counted.h"
#include "leaf/table/mode_lookup.h"
#include "leaf/table/mode_table_cache.h"
#include "leaf/table/mode_table_file.h"
#include "leaf/table/reciprocal_modes.h"
#include "materials/leaf_fluorescence.h"
#include "materials/leaf_params.h"
#include "materials/lobes/active_lanes.h"
#include "materials/lobes/solved_bsdf.h"
#include "materials/table_file_param.h"
#include "materials/table_wavelengths.h"

namespace frond {
namespace {

constexpr Param kOwnLeafSolvedParams[] = {
    {.name = "tolerance",
     .kind = ParamKind::real,
     .default_value = 5e-4,
     .range = {1e-5, 0.1},
     .doc = "Largest error of the mode table, by omitted modes and by interpolation between angles, relative to a "
            "white Lambertian BSDF. With tablefile: the largest error that the look-up adds."},
    {.name = "tablefile",
     .kind = ParamKind::string,
     .doc = "File with the leaf's mode table, made by frond table leaf_solved (docs/file_formats.md); replaces all "
            "parameters of the tissue."},
};
const std::vector<Param> kLeafSolved = with_leaf_params(kOwnLeafSolvedParams);

/// Leaf by the solved walk of `abm`: the same BSDF without noise.
class LeafSolved final : public Material, public FluorescentMaterial {
 public:
  explicit LeafSolved(const Params& p)
      : leaf_(p),
        varies_(!leaf_.depth().is_constant() && !p.given("tablefile")),
        surface_texture_(leaf_.cuticle_aspect()),
        exponent_(leaf_.tissue().cuticle_aspect),
        tolerance_(p.real("tolerance")),
        file_(p, {}) {
    if (file_.is_given())
      modes_of_file_ =
          std::make_shared<const leaf::ModeTableFile>(leaf::read_mode_table_file(file_.path(), file_.where()));
    else
      leaf_.reject_wall_textures(p);
  }

  void prepare(const Preparation& preparation) override {
    file_.warn(preparation.log);
    surface_ = preparation.share<leaf::CutLobe>(fmt::format("surface lobe {}", exponent_),
                                                [&] { return leaf::CutLobe(exponent_); });
    fixed_.reset();
    if (file_.is_given())
      table_ = preparation.share<leaf::ModeLookup>(
          key(preparation, fmt::format("mode table file {} {}", tolerance_, file_.path().string())),
          [&] { return read_table(preparation); });
    else
      make_table(preparation);
    if (leaf_.is_reciprocal()) scale_surface(preparation);
    // With fixed wavelengths and one depth the selection is the same at every hit.
    if (table_->lanes_are_columns()) fixed_ = table_->select(preparation.wavelengths.sample(0));
  }

  const Bsdf* evaluate(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const override {
    const leaf::Lobe* surface = surface_texture_
                                    ? arena.make<leaf::Lobe>(static_cast<double>(surface_texture_->evaluate(hit.at)))
                                    : surface_.get();
    // Lobe and selection lie in the arena or in this material, which both outlive the BSDF.
    SolvedHit at{table_.get(), selection(hit, lambda, arena), surface, lane_mask(lambda), leaf_.incident()};
    if (scaling_) {
      at.scaling = scaling_.get();
      at.exponent = scaling_->position(static_cast<float>(surface->exponent()));
    }
    return arena.make<SolvedBsdf>(at);
  }

  bool is_reciprocal() const override { return leaf_.is_reciprocal(); }

  std::shared_ptr<const Fluorescence> fluorescence(const Preparation& preparation) const override {
    if (file_.is_given()) return only_matrix_fluorescence(leaf_, preparation.log);
    if (auto given = matrix_fluorescence(leaf_, preparation.log)) return given;
    if (leaf_.tissue().fluorescence == 0) return only_matrix_fluorescence(leaf_, preparation.log);  // black
    leaf_.refuse_varying_fluorescence();
    if (leaf_.tissue().fluorescence == 0) return std::make_shared<const MatrixFluorescence>(nullptr);
    const auto make = [&] { return leaf::FluorescenceTable(leaf_.tissue(), preparation.pool); };
    const std::string key = "fluorescence table " + describe(leaf_.tissue());
    return std::make_shared<const SolvedFluorescence>(leaf_, preparation.share<leaf::FluorescenceTable>(key, make));
  }

 private:
  using Selection = leaf::ModeLookup::Selection;

  const Selection* selection(const Hit& hit, const SampledWavelengths& lambda, Arena& arena) const {
    if (varies_) return arena.make<Selection>(table_->select(lambda, leaf_.depth().at(hit.at, lambda)));
    return fixed_ ? &*fixed_ : arena.make<Selection>(table_->select(lambda));
  }

  /// Makes the mode table or reads it from the cache; materials of one leaf share it.
  void make_table(const Preparation& preparation) {
    leaf_.check_wavelengths(preparation.wavelengths);
    leaf_.log_difference(preparation.log);
    const leaf::ModeTableRequest request = request_for(preparation.wavelengths);
    const bool vary = preparation.wavelengths.fixed_nm().empty();
    const auto make = [&] {
      leaf::ModeTable spectrum =
          leaf::cached_mode_table(request, leaf_.specimen(), preparation.pool, preparation.log, preparation.cache_dir);
      if (leaf_.is_reciprocal()) spectrum = leaf::make_reciprocal(spectrum).value();
      leaf::ModeLookup table(request, spectrum, vary);
      preparation.log.info(fmt::format("mode table: {}, {} kB in memory", leaf_.specimen(), table.bytes() / 1024));
      return table;
    };
    table_ = preparation.share<leaf::ModeLookup>(key(preparation, describe(request)), make);
  }

  // Key of the look-up table that materials share.
  std::string key(const Preparation& preparation, const std::string& what) const {
    return (leaf_.is_reciprocal() ? "reciprocal " : "") + wavelengths_key(preparation.wavelengths) + what;
  }

  /// Tabulates the factors that make the surface's lobe reciprocal.
  void scale_surface(const Preparation& preparation) {
    const Interval exponents = leaf_.exponents(exponent_), indices = table_->indices();
    scaling_ = preparation.share<leaf::SurfaceScaling>(
        fmt::format("surface scaling {} {} {} {}", exponents.min, exponents.max, indices.min, indices.max),
        [&] { return leaf::SurfaceScaling(exponents, indices); });
  }

  /// The table of "tablefile".
  leaf::ModeLookup read_table(const Preparation& preparation) const {
    const std::string name = file_.path().string();
    const leaf::ModeTableFile& file = *modes_of_file_;
    const leaf::ModeTableRequest request{
        .params = {},
        .wavelengths_nm = file_wavelengths(file.wavelengths_nm(), preparation.wavelengths, file_.where(), name),
        .tolerance = tolerance_};
    leaf::ModeTable spectrum = leaf::at_wavelengths(file, request.wavelengths_nm);
    if (leaf_.is_reciprocal()) {
      auto reciprocal = leaf::make_reciprocal(spectrum);
      if (!reciprocal)
        fail(file_.where(), "{}: no reciprocal BSDF scatters as much light as this mode table does in every direction",
             name);
      spectrum = std::move(*reciprocal);
    }
    leaf::ModeLookup table(request, spectrum, preparation.wavelengths.fixed_nm().empty());
    preparation.log.info(fmt::format("mode table: {}, {}, {} kB in memory", name,
                                     counted(file.columns.size(), "wavelength"), table.bytes() / 1024));
    return table;
  }

  leaf::ModeTableRequest request_for(const WavelengthStrategy& wavelengths) const {
    const double tolerance = leaf_.is_reciprocal() ? tolerance_ / leaf::kReciprocalFiner : tolerance_;
    leaf::ModeTableRequest request{.params = leaf_.tissue(), .wavelengths_nm = {}, .tolerance = tolerance};
    request.params.cuticle_aspect = 0;  // does not affect light inside: leaves with other cuticles share the table
    request.wavelengths_nm = varies_ ? index_wavelengths(wavelengths) : table_wavelengths(wavelengths);
    if (varies_) request.depths = depth_axis(leaf_.depth(), wavelengths, leaf::kDepthStep);
    return request;
  }

  LeafParams leaf_;
  bool varies_;                                          ///< the optical depth varies over the leaf
  LeafParams::Aspect surface_texture_;                   ///< exponent of the surface's lobe; nullptr: constant
  double exponent_;                                      ///< of the surface's lobe if it is constant
  std::shared_ptr<const leaf::CutLobe> surface_;         ///< lobe with that exponent
  std::shared_ptr<const leaf::SurfaceScaling> scaling_;  ///< nullptr: not reciprocal
  double tolerance_;
  TableFileParam file_;
  std::shared_ptr<const leaf::ModeTableFile> modes_of_file_;  ///< nullptr: no file is given
  std::shared_ptr<const leaf::ModeLookup> table_;
  std::optional<Selection> fixed_;  ///< selection of all hits, if it is the same for all
};

}  // namespace

extern const MaterialInfo leaf_solved_material{
    {"material", "leaf_solved",
     "Leaf by the solution of abm's random walk: the BSDF that abm converges to, without noise.",
     "docs/leaf_models.md; the walk: Baranoski and Rokne 1997; Baranoski 2006; Baranoski and Eng 2007", kLeafSolved},
    make_material<LeafSolved>,
    LeafModel{.reference = "abm", .is_exact = true, .cost = 1.15, .table = LeafModel::Table::modes}};

}  // namespace frond
