#pragma once

#include "instruments/beam.h"
#include "leaf/tissue/tissue_params.h"
#include "tests/materials/support.h"
#include "tests/stability/leaf_methods.h"

namespace frond::stability {

using Parameters = std::vector<ParsedParam>;

/// The scene parameters of a leaf, except for further pigments.
Parameters words_for(const leaf::TissueParams& leaf);

/// A registered material, prepared for one wavelength.
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

/// A leaf for every registered leaf material. `pigments` are parameters that TissueParams does not have.
struct LeafInScene {
  leaf::TissueParams leaf;
  double lambda_nm;
  Parameters pigments = {};
};

/// A registered leaf material and the column of its default parameters.
struct LeafMaterial {
  Method method;
  std::string_view name;
};
inline constexpr LeafMaterial kLeafMaterials[] = {{Method::abm, "abm"},
                                                  {Method::simplified, "leaf_simplified"},
                                                  {Method::solved_leaf, "leaf_solved"},
                                                  {Method::lambert, "leaf_lambert"}};

/// Default "tolerance" of leaf_solved.
inline constexpr double kModesTolerance = 5e-4;

/// Adds the cells of all registered leaf materials except `leaf_solved`, whose mode table takes longer: one is made for
/// all rows of a leaf. `table_bound`: largest accepted error of looking up a solved table.
void compare_material_methods(Row& row, const LeafInScene& leaf, const Lit& lit, double table_bound);

Specimen solved_specimen(const LeafInScene& leaf);

/// Adds the cell of R and T of `leaf_solved`, made by `solved_specimen`.
void compare_solved_leaf(Row& row, const Specimen& solved, const Lit& lit);

/// R and T of a material whose f is exact, without noise.
leaf::Shares integrate_shares(const Specimen& specimen, double theta_deg);

/// Rs, Rd and T of `leaf_simplified` at one angle, from its BSDF without noise. `simplified` has "surfacedirect" false,
/// so that Rs is the weight of a separate lobe.
leaf::Shares read_off(const Bsdf& simplified, const Vec3& wo);

/// Mean weights of `samples` calls of `sample`.
MeasuredShares sample_many(const Bsdf& bsdf, const Vec3& wo, int samples);

}  // namespace frond::stability
