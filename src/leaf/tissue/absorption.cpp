#include "leaf/tissue/absorption.h"

namespace frond::leaf {
namespace {

double specific(const LeafNumber& n, AbsorptionTables tables, double lambda_nm, const Constants& published,
                const ProspectConstants& prospect) {
  if (!n.spectrum.empty()) return interpolate(n.spectrum, lambda_nm);
  if (n.is_of_prospect() || (n.prospect && tables == AbsorptionTables::prospect)) return prospect.*n.prospect;
  return n.published ? published.*n.published : 1;
}

/// Absorption coefficient of a pigment, 1/m.
double coefficient(const Pigment& pigment, double lambda_nm) {
  const auto [i, t] = kAbsorptionGrid.cell(lambda_nm);
  const std::vector<double>& s = pigment.specific_absorption;
  return pigment.concentration * ((1 - t) * s[i] + t * s[i + 1]);
}

}  // namespace

const std::vector<Absorber>& absorbers() {
  static const std::vector<Absorber> all = [] {
    std::vector<Absorber> found;
    for (const LeafNumber& n : kLeafNumbers)
      if (n.absorbs() && n.follows.empty()) found.push_back({{&n}});
    for (const LeafNumber& n : kLeafNumbers)
      for (Absorber& a : found)
        if (n.follows == a.first().name) a.numbers.push_back(&n);
    return found;
  }();
  return all;
}

double specific_absorption(const LeafNumber& number, AbsorptionTables tables, double lambda_nm) {
  return specific(number, tables, lambda_nm, constants_at(lambda_nm), prospect_constants_at(lambda_nm));
}

double absorption_coefficient(const TissueParams& p, double lambda_nm) {
  const Constants published = constants_at(lambda_nm);
  const ProspectConstants prospect = prospect_constants_at(lambda_nm);
  // The order of the sum is fixed, so that leaves of the published model keep their results to the bit: the model's
  // constituents come before others, and concentrations before coefficients.
  double sum = 0, others = 0;
  for (const bool is_mass : {true, false})
    for (const Absorber& a : absorbers()) {
      const LeafNumber& n = a.first();
      if ((n.unit == kMassPerVolume) != is_mass) continue;
      (n.is_of_prospect() || !n.spectrum.empty() ? others : sum) +=
          a.amount(p) * specific(n, p.absorption_tables, lambda_nm, published, prospect);
    }
  sum += others;
  for (const Pigment& pigment : p.pigments) sum += coefficient(pigment, lambda_nm);
  return sum;
}

double fluorescing_share(const TissueParams& p, double lambda_nm) {
  const Constants published = constants_at(lambda_nm);
  const ProspectConstants prospect = prospect_constants_at(lambda_nm);
  double sum = 0;
  for (const Absorber& a : absorbers())
    if (a.first().fluoresces)
      sum += a.amount(p) * specific(a.first(), p.absorption_tables, lambda_nm, published, prospect);
  for (const Pigment& pigment : p.pigments)
    if (pigment.fluoresces) sum += coefficient(pigment, lambda_nm);
  return sum > 0 ? std::min(1.0, sum / absorption_coefficient(p, lambda_nm)) : 0;
}

std::vector<double> absorption_coefficients(const TissueParams& params) {
  std::vector<double> result;
  for (size_t i = 0; i < kAbsorptionGrid.size(); ++i)
    result.push_back(absorption_coefficient(params, kAbsorptionGrid.nm(i)));
  return result;
}

}  // namespace frond::leaf
