#include "tests/stability/solved_f.h"

#include <numbers>

#include "leaf/solve/modes.h"
#include "leaf/tissue/fresnel.h"

namespace frond::stability {
namespace {

/// A direction; theta is measured from the normal of the side `below` names.
struct Direction {
  double theta_deg, azimuth;
  bool below;

  Vec3 vector() const {
    const double sine = std::sin(theta_deg * kDegree), cosine = std::cos(theta_deg * kDegree);
    return {float(sine * std::cos(azimuth)), float(sine * std::sin(azimuth)), float(below ? -cosine : cosine)};
  }
};

/// f from the cosine series at exactly the given angles and the surface's lobe in closed form.
class TrueF {
 public:
  TrueF(const leaf::Tissue& tissue, const std::vector<double>& theta_deg) : tissue_(tissue) {
    std::vector<double> sines;
    for (const double theta : theta_deg) sines.push_back(std::sin(theta * kDegree));
    modes_ = leaf::solve_modes(tissue, sines, 1e-5, 2 * leaf::mode_nodes(tissue));
  }

  /// f of directions whose angles have the indices `i` and `o`; wo is the incident direction.
  double at(const Direction& wo, const Direction& wi, size_t i, size_t o) const {
    const double cos_i = std::cos(wo.theta_deg * kDegree), cos_o = std::cos(wi.theta_deg * kDegree);
    const double phi = wi.azimuth - wo.azimuth - std::numbers::pi;  // 0: straight on
    double sum = 0;
    int m = 0;
    for (const leaf::LeafModes::Grid& h : modes_.series(wo.below, wo.below != wi.below))
      sum += h[i * modes_.sines().size() + o] * std::cos(m++ * phi);
    const double body = leaf::interface_transmittance(tissue_, cos_i, cos_o) * sum;
    return wo.below == wi.below ? body + surface(wo.vector(), wi.vector(), cos_i, cos_o) : body;
  }

 private:
  double surface(const Vec3& wo, const Vec3& wi, double cos_i, double cos_o) const {
    const leaf::Lobe& lobe = tissue_.surface_lobe();
    const double cos_alpha = double(wo.z * wi.z - wo.x * wi.x - wo.y * wi.y);
    const double reflectance = leaf::fresnel(cos_i, 1 / tissue_.n_cuticle()).reflectance;
    return reflectance * lobe.density(cos_alpha) / lobe.kept_share(cos_i) / cos_o;
  }

  const leaf::Tissue& tissue_;
  leaf::LeafModes modes_;
};

}  // namespace

Cell compare_solved_f(Specimen& specimen, const leaf::Tissue& tissue, const std::vector<double>& theta_deg,
                      double bound) {
  const TrueF truth(tissue, theta_deg);
  const Bsdf& bsdf = specimen.bsdf();
  RandomStream rng(8);
  Comparison comparison(bound);
  for (size_t i = 0; i < theta_deg.size(); ++i)
    for (size_t o = 0; o < theta_deg.size(); ++o)
      for (const bool from_below : {false, true})
        for (const bool to_below : {false, true})
          for (const double azimuth : {0.0, 1.0, 2.0, std::numbers::pi}) {
            const Direction wo{theta_deg[i], 0, from_below}, wi{theta_deg[o], azimuth, to_below};
            const double f = double(bsdf.f(wo.vector(), wi.vector(), rng)[0]);
            comparison.add("pi f", std::numbers::pi * f, std::numbers::pi * truth.at(wo, wi, i, o));
          }
  return comparison.cell();
}

}  // namespace frond::stability
