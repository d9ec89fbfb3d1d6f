#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/params.h"
#include "core/wavelengths.h"
#include "leaf/fluorescence/emission.h"
#include "leaf/fluorescence/emission_matrices.h"
#include "leaf/plates/plate_leaf.h"
#include "leaf/table/depth_map.h"
#include "leaf/tissue/specimens.h"
#include "materials/lobes/incident.h"

namespace frond {

/// Parameters of every leaf material, so that one can replace another in a scene. Parameters without a default are the
/// specimen's. The numbers among them are the rows of leaf/tissue/leaf_numbers.h.
const std::vector<Param>& leaf_params();

/// Whether the parameter is of the tissue, which a table of its reflectance and transmittance replaces. The surface's
/// shape, the direction and matrices of fluorescence are not.
bool is_of_tissue(const Param& leaf_param);

/// The leaf's parameters and then a material's own.
std::vector<Param> with_leaf_params(std::span<const Param> own);

/// The parameters of a material that cannot be reciprocal.
std::vector<Param> without_reciprocal(std::vector<Param> params);

/// The leaf that a scene describes, from the parameters above.
class LeafParams {
 public:
  /// What a material makes of PROSPECT's parameters.
  enum class Plates : uint8_t {
    walk,   ///< the leaf of the walk that is nearest to them
    table,  ///< nothing here: TableFileParam has their R and T
  };

  /// Throws InputError if pigments and their concentrations differ in number, a file cannot be read, or PROSPECT's
  /// parameters are incomplete or beside those of the tissue.
  explicit LeafParams(const Params& p, Plates plates = Plates::walk);

  /// Constant parameters; where a texture gives a parameter, its largest value.
  const leaf::TissueParams& tissue() const { return tissue_; }
  /// Optical depth of the mesophyll, by point and wavelength.
  const leaf::DepthMap& depth() const { return depth_; }
  /// Whether no parameter varies over the leaf.
  bool is_constant() const { return depth_.is_constant() && aspects_are_constant(); }
  /// Whether no texture gives an aspect ratio.
  bool aspects_are_constant() const { return aspects_.empty(); }
  /// nullptr where the aspect ratio is constant.
  using Aspect = std::shared_ptr<const FloatTexture>;
  const Aspect& cuticle_aspect() const { return aspect(&leaf::TissueParams::cuticle_aspect); }
  const Aspect& epidermis_aspect() const { return aspect(&leaf::TissueParams::epidermis_aspect); }
  const Aspect& spongy_aspect() const { return aspect(&leaf::TissueParams::spongy_aspect); }
  const Aspect& palisade_aspect() const { return aspect(&leaf::TissueParams::palisade_aspect); }

  /// Incident direction that the scene requests.
  Incident incident() const { return incident_; }
  /// Whether the scene requests the reciprocal BSDF.
  bool is_reciprocal() const { return incident_ == Incident::reciprocal; }
  /// Range of the surface lobe's exponents: the range of the cuticle's texture, or else `constant`.
  Interval exponents(double constant) const {
    return cuticle_aspect() ? cuticle_aspect()->range() : Interval{constant, constant};
  }
  /// Name of the specimen, for the log.
  std::string specimen() const { return plates_ ? "PROSPECT" : specimen_; }

  /// Distribution of the wavelengths of fluorescence.
  const leaf::EmissionShape& emission() const { return emission_; }
  /// Matrices that replace the fluorescence of the model; nullptr: none are given.
  const std::shared_ptr<const leaf::EmissionMatrices>& matrices() const { return matrices_; }
  /// Where the scene names the material.
  const Location& where() const { return where_; }

  /// Throws InputError if a texture gives the aspect ratio of an inner wall: for materials whose tables hold for one
  /// tissue. The cuticle affects the surface alone.
  void reject_wall_textures(const Params& p) const;

  /// Throws InputError if a leaf with a quantum yield varies over its surface: fluorescence is computed for one tissue.
  void refuse_varying_fluorescence() const;

  /// Throws InputError if the optical constants or a pigment's data do not cover the wavelengths.
  void check_wavelengths(const WavelengthStrategy& wavelengths) const;

  /// Logs by how much R and T of the walk differ from PROSPECT's, where its parameters are given.
  void log_difference(const Log& log) const;

 private:
  struct PigmentData {
    std::string file;
    Interval range_nm;
  };
  using Varying = std::vector<leaf::DepthMap::Varying>;

  const Aspect& aspect(double leaf::TissueParams::*member) const;

  /// Fill in the members before `depth_`.
  leaf::DepthMap read(const Params& p, Plates plates);
  void read_pigments(const Params& p, Varying& varying);

  std::string specimen_;
  Location where_, pigments_where_;
  leaf::TissueParams tissue_;
  std::vector<std::pair<const leaf::LeafNumber*, Aspect>> aspects_;  ///< those that vary
  std::vector<PigmentData> pigment_data_;
  Incident incident_;
  std::optional<leaf::PlateLeaf> plates_;  ///< PROSPECT's parameters
  leaf::DepthMap depth_;
  leaf::EmissionShape emission_;
  std::shared_ptr<const leaf::EmissionMatrices> matrices_;
};

/// Returns the leaf of PROSPECT's parameters; nullopt: none is given, or a file replaces the tissue. Throws InputError
/// if one is missing.
std::optional<leaf::PlateLeaf> plate_leaf(const Params& p);

}  // namespace frond
