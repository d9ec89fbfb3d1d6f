#include "leaf/tissue/absorption.h"

#include "leaf/tissue/prospect.h"

namespace frond::leaf {

Constants constants_at(double lambda_nm, AbsorptionTables tables) {
  Constants c = constants_at(lambda_nm);
  if (tables == AbsorptionTables::prospect) {
    const ProspectConstants other = prospect_constants_at(lambda_nm);
    c.chlorophyll = other.chlorophyll, c.carotenoids = other.carotenoids, c.water = other.water;
  }
  return c;
}

double absorption_coefficient(const TissueParams& p, double lambda_nm) {
  const Constants c = constants_at(lambda_nm, p.absorption_tables);
  double sum = (p.chlorophyll_a + p.chlorophyll_b) * c.chlorophyll + p.carotenoids * c.carotenoids +
               p.protein * c.protein + (p.cellulose + p.lignin) * c.cellulose + c.water + p.other_absorption;
  if (p.anthocyanins > 0 || p.dry_matter > 0 || p.brown_pigments > 0) {
    const ProspectConstants other = prospect_constants_at(lambda_nm);
    sum +=
        p.anthocyanins * other.anthocyanins + p.dry_matter * other.dry_matter + p.brown_pigments * other.brown_pigments;
  }
  const auto [i, t] = kAbsorptionGrid.cell(lambda_nm);
  for (const Pigment& pigment : p.pigments) {
    const std::vector<double>& s = pigment.specific_absorption;
    sum += pigment.concentration * ((1 - t) * s[i] + t * s[i + 1]);
  }
  return sum;
}

std::vector<double> absorption_coefficients(const TissueParams& params) {
  std::vector<double> result;
  for (size_t i = 0; i < kAbsorptionGrid.size(); ++i)
    result.push_back(absorption_coefficient(params, kAbsorptionGrid.nm(i)));
  return result;
}

}  // namespace frond::leaf
