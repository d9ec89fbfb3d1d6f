#pragma once

#include "instruments/beam.h"
#include "leaf/tissue/tissue_params.h"
#include "tests/materials/support.h"
#include "tests/stability/leaf_methods.h"

namespace frond::stability {

using Parameters = std::vector<ParsedParam>;

/// The scene's words for a leaf, all but further pigments.
Parameters words_for(const leaf::TissueParams& leaf);

/// A registered material made ready for one wavelength.
class Specimen {
 public:
  Specimen(std::string_view material, Parameters params, double lambda_nm);

  const Bsdf& bsdf();
  const Material& material() const { return *material_; }
  double lambda_nm() const { return lambda_nm_; }
  const ThreadPool& pool() const { return pool_; }

 private:
  ThreadPool pool_{1};
  Arena arena_;
  double lambda_nm_;
  std::unique_ptr<Material> material_;
};

Vec3 toward_in_float(double theta_deg);

/// What a leaf in a scene returns of the light, by the means of every registered material that can be it. `pigments`
/// are parameters that TissueParams does not spell.
struct LeafInScene {
  leaf::TissueParams leaf;
  double lambda_nm;
  Parameters pigments = {};
};

/// Every registered leaf material, and the column of what it does by default.
struct LeafMaterial {
  Method method;
  std::string_view name;
};
inline constexpr LeafMaterial kLeafMaterials[] = {{Method::abm, "abm"},
                                                  {Method::simplified, "leaf_simplified"},
                                                  {Method::solved_leaf, "leaf_solved"},
                                                  {Method::lambert, "leaf_lambert"}};

/// What leaf_solved's own "tolerance" allows.
inline constexpr double kModesTolerance = 5e-4;

/// Fills in the cells of everything that works on a registered leaf material. `table_bound`: on the error of looking up
/// a table that was solved. But `leaf_solved`, whose modes cost more: it is made once for all rows about a leaf.
void compare_material_methods(Row& row, const LeafInScene& leaf, const Lit& lit, double table_bound);

Specimen solved_specimen(const LeafInScene& leaf);

/// Fills in the cell of R and T of `leaf_solved`, made by `solved_specimen`.
void compare_solved_leaf(Row& row, const Specimen& solved, const Lit& lit);

/// R and T of a material whose f is exact, without noise.
leaf::Shares integrate_shares(const Specimen& specimen, double theta_deg);

/// Rs, Rd and T of `leaf_simplified` at one angle, read off its BSDF without noise. `simplified` has "surfacedirect"
/// false: so Rs is the weight of a lobe of its own.
leaf::Shares read_off(const Bsdf& simplified, const Vec3& wo);

/// Mean weights of `samples` calls of `sample`.
MeasuredShares sample_many(const Bsdf& bsdf, const Vec3& wo, int samples);

}  // namespace frond::stability
