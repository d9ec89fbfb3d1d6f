#pragma once

#include "instruments/beam.h"
#include "leaf/tissue_params.h"
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

/// Fills in the cells of everything that works on a registered leaf material. `table_bound`: on the error of looking up
/// a table that was solved.
void compare_material_methods(Row& row, const LeafInScene& leaf, const Lit& lit, double table_bound);

/// Rs, Rd and T of `leaf_simplified` at one angle, read off its BSDF without noise. `simplified` has "surfacedirect"
/// false: so Rs is the weight of a lobe of its own.
leaf::Shares read_off(const Bsdf& simplified, const Vec3& wo);

/// Mean weights of `samples` calls of `sample`.
MeasuredShares sample_many(const Bsdf& bsdf, const Vec3& wo, int samples);

}  // namespace frond::stability
