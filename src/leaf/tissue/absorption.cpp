#include "leaf/tissue/absorption.h"

namespace frond::leaf {

double absorption_coefficient(const TissueParams& p, double lambda_nm) {
  const Constants c = constants_at(lambda_nm);
  double sum = (p.chlorophyll_a + p.chlorophyll_b) * c.chlorophyll + p.carotenoids * c.carotenoids +
               p.protein * c.protein + (p.cellulose + p.lignin) * c.cellulose + c.water + p.other_absorption;
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
