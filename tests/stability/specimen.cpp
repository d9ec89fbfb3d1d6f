#include "tests/stability/specimen.h"

#include <optional>

#include "core/log.h"
#include "instruments/goniophotometer.h"
#include "instruments/spectrophotometer.h"
#include "leaf/tissue/leaf_numbers.h"

namespace frond::stability {

using leaf::Fate;
using leaf::Shares;
using leaf::TissueParams;
using test::flag;
using test::number;
using test::words;

namespace {

constexpr int kInstrumentSamples = 4000, kTableWalks = 1000;
constexpr int64_t kInstrumentRays = 50000;

Fate fate_of(const Vec3& wo, const BsdfSample& sample) {
  if (!same_side(wo, sample.wi)) return Fate::transmitted;
  return any(sample.flags & Lobes::surface) ? Fate::surface : Fate::reflected;
}

Parameters with(Parameters params, Parameters more) {
  params.insert(params.end(), more.begin(), more.end());
  return params;
}

Parameters words_of(const LeafInScene& leaf) { return with(words_for(leaf.leaf), leaf.pigments); }

Cell sampled(Specimen& specimen, const Lit& lit) {
  Comparison comparison;
  for (size_t i = 0; i < lit.theta_deg.size(); ++i)
    add_shares(comparison, sample_many(specimen.bsdf(), toward_in_float(lit.theta_deg[i]), kInstrumentSamples),
               lit.truth[i]);
  return comparison.cell();
}

Cell measured(const Specimen& specimen, const Lit& lit) {
  Comparison comparison;
  for (size_t i = 0; i < lit.theta_deg.size(); ++i) {
    const Beam beam{lit.theta_deg[i], specimen.lambda_nm()};
    const auto measurement = measure_shares({specimen.material(), beam}, {kInstrumentRays}, specimen.pool());
    comparison.add("Rs", measurement.surface, lit.truth[i].surface, kInstrumentRays);
    comparison.add("Rd", measurement.subsurface, lit.truth[i].subsurface, kInstrumentRays);
    comparison.add("T", measurement.transmittance, lit.truth[i].transmitted, kInstrumentRays);
  }
  return comparison.cell();
}

/// For methods that return R but not Rs and Rd.
void add_all_reflected(Comparison& comparison, const Shares& value, const Shares& truth) {
  comparison.add("R", value.surface + value.subsurface, truth.surface + truth.subsurface);
  comparison.add("T", value.transmitted, truth.transmitted);
}

Cell looked_up(Specimen& specimen, const Lit& lit, double bound) {
  Comparison comparison(bound);
  for (size_t i = 0; i < lit.theta_deg.size(); ++i)
    add_shares(comparison, read_off(specimen.bsdf(), toward_in_float(lit.theta_deg[i])), lit.truth[i]);
  return comparison.cell();
}

/// The cell of `leaf_lambert`, with a separate leaf for each angle of incidence; none if all angles are outside its
/// range.
std::optional<Cell> given_incidence(const Parameters& params, double lambda_nm, const Lit& lit, double bound) {
  Comparison comparison(bound);
  bool any = false;
  for (size_t i = 0; i < lit.theta_deg.size(); ++i) {
    const double theta = lit.theta_deg[i], from_normal = std::min(theta, 180 - theta);
    if (from_normal > 89) continue;
    Specimen lambert("leaf_lambert", with(params, {number("float", "incidence", {from_normal})}), lambda_nm);
    add_all_reflected(comparison, read_off(lambert.bsdf(), toward_in_float(theta)), lit.truth[i]);
    any = true;
  }
  return any ? std::optional(comparison.cell()) : std::nullopt;
}

/// Noise of a table with `rays` walks at each angle, for a look-up between neighbouring angles.
Cell looked_up_in_walked(Specimen& specimen, const Lit& lit, double bound) {
  Comparison comparison(bound);
  const auto add = [&](std::string_view what, double value, double truth) {
    const double variance = std::max(0.0, truth * (1 - truth)) / kTableWalks;
    comparison.add(what, Estimate{value, variance}, truth, kTableWalks);
  };
  for (size_t i = 0; i < lit.theta_deg.size(); ++i) {
    const Shares value = read_off(specimen.bsdf(), toward_in_float(lit.theta_deg[i]));
    add("Rs", value.surface, lit.truth[i].surface);
    add("Rd", value.subsurface, lit.truth[i].subsurface);
    add("T", value.transmitted, lit.truth[i].transmitted);
  }
  return comparison.cell();
}

}  // namespace

Parameters words_for(const TissueParams& leaf) {
  Parameters all{
      words("specimen", {leaf.structure == leaf::Structure::bifacial ? "soybean" : "maize"}),
      flag("sieve", leaf.sieve_and_detour),
      words("absorption", {leaf.absorption_tables == leaf::AbsorptionTables::prospect ? "prospect" : "baranoski"})};
  for (const leaf::LeafNumber& n : leaf::leaf_parameters())
    all.push_back(number("float", std::string(n.name), {n.value(leaf)}));
  return all;
}

Specimen::Specimen(std::string_view material, Parameters params, double lambda_nm) : lambda_nm_(lambda_nm) {
  test::Resolver resolver;
  const MaterialInfo& info = test::material_info(material);
  material_ = info.make(Params(info, {std::string(material), {}, std::move(params)}, resolver));
  const OneWavelength strategy(lambda_nm);
  material_->prepare({strategy, pool_, silent_log(), {}});
}

const Bsdf& Specimen::bsdf() {
  arena_.reset();
  return bsdf_of(*material_, {0, lambda_nm_}, arena_);
}

Vec3 toward_in_float(double theta_deg) {
  const Vec3d w = toward(theta_deg);
  return {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)};
}

Shares read_off(const Bsdf& simplified, const Vec3& wo) {
  RandomStream rng(1);
  const Vec3 ahead{0, 0, wo.z < 0 ? -1.f : 1.f};
  Shares shares;
  shares.subsurface = double(simplified.f(wo, ahead, rng)[0]) * std::numbers::pi;
  shares.transmitted = double(simplified.f(wo, -ahead, rng)[0]) * std::numbers::pi;
  // Small first numbers choose the surface's lobe, whatever its probability.
  for (float u = 0.5f; u > 1e-7f && shares.surface == 0; u /= 2) {
    const auto s = simplified.sample(wo, 0, {u, 0.4f}, rng);
    if (s && any(s->flags & Lobes::surface)) shares.surface = double(s->f[0]) * double(std::abs(s->wi.z));
  }
  return shares;
}

MeasuredShares sample_many(const Bsdf& bsdf, const Vec3& wo, int samples) {
  MeasuredShares measured;
  RandomStream rng(5);
  for (int i = 0; i < samples; ++i) {
    const float uc = rng.uniform(), u = rng.uniform();
    const auto s = bsdf.sample(wo, uc, {u, rng.uniform()}, rng);
    if (s)
      measured.add(fate_of(wo, *s), double(s->f[0] * std::abs(s->wi.z) / s->pdf));
    else
      measured.add(Fate::absorbed, 0);
  }
  return measured;
}

Shares integrate_shares(const Specimen& specimen, double theta_deg) {
  const GoniophotometerMeasurement measurement =
      integrate_f({specimen.material(), {theta_deg, specimen.lambda_nm()}}, DetectorSphere(2, 1), specimen.pool());
  return {0, measurement.share(true).mean, measurement.share(false).mean};
}

Specimen solved_specimen(const LeafInScene& leaf) { return {"leaf_solved", words_of(leaf), leaf.lambda_nm}; }

void compare_solved_leaf(Row& row, const Specimen& solved, const Lit& lit) {
  Comparison comparison(kModesTolerance);
  for (size_t i = 0; i < lit.theta_deg.size(); ++i)
    add_all_reflected(comparison, integrate_shares(solved, lit.theta_deg[i]), lit.truth[i]);
  row.add(Method::solved_leaf, comparison.cell());
}

void compare_material_methods(Row& row, const LeafInScene& leaf, const Lit& lit, double table_bound) {
  const Parameters params = words_of(leaf);
  Specimen abm("abm", params, leaf.lambda_nm);
  row.add(Method::abm, sampled(abm, lit));
  row.add(Method::spectrophotometer, measured(abm, lit));
  Specimen solved("leaf_simplified", with(params, {words("tablemethod", {"solve"}), flag("surfacedirect", false)}),
                  leaf.lambda_nm);
  row.add(Method::simplified, looked_up(solved, lit, table_bound));
  Specimen walked("leaf_simplified",
                  with(params, {words("tablemethod", {"montecarlo"}), flag("surfacedirect", false),
                                number("integer", "tablerays", {kTableWalks})}),
                  leaf.lambda_nm);
  row.add(Method::simplified_walked, looked_up_in_walked(walked, lit, table_bound));
  if (const auto cell = given_incidence(params, leaf.lambda_nm, lit, table_bound)) row.add(Method::lambert, *cell);
}

}  // namespace frond::stability
