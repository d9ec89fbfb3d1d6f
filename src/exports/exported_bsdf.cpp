#include "exports/exported_bsdf.h"

#include "core/bsdf.h"
#include "instruments/beam.h"
#include "instruments/given_wavelengths.h"
#include "leaf/tissue/leaf_numbers.h"

namespace frond {
namespace {

/// Evaluates the material on a flat surface. Throws InputError if it returns no BSDF.
const Bsdf& evaluated(const Material& material, const std::vector<double>& nm, Arena& arena) {
  const GivenWavelengths wavelengths({nm.begin(), nm.end()});
  const Bsdf* bsdf = material.evaluate(flat_hit(), wavelengths.sample(0), arena);
  if (!bsdf) fail({}, "the material has no surface there (an alpha of 0, for one): it cannot be exported");
  return *bsdf;
}

/// Throws InputError for a BSDF that a table of f cannot represent.
void check(const Bsdf& bsdf, const std::string& label) {
  if (any(bsdf.flags() & Lobes::stochastic))
    fail({}, "{}: its f is a random estimate, which no table can hold; for a leaf of abm, leaf_solved is the mean",
         label);
  if (any(bsdf.flags() & Lobes::specular)) fail({}, "{}: it has a delta lobe, which no table of f can hold", label);
  const SampledSpectrum ratio = bsdf.index_ratio();
  for (int i = 0; i < kLanes; ++i)
    if (ratio[i] != 1)
      fail({}, "{}: it refracts light into another medium; exports are of sheets with air on both sides", label);
}

}  // namespace

ExportedBsdf::ExportedBsdf(const ExportMaterial& material, std::vector<double> wavelengths_nm)
    : wavelengths_nm_(std::move(wavelengths_nm)), material_(material.prepare(wavelengths_nm_)) {
  Arena arena;
  check(evaluated(*material_, wavelengths_nm_, arena), material.label);
}

ExportedBsdf::At::At(const ExportedBsdf& bsdf) : bsdf_(evaluated(*bsdf.material_, bsdf.wavelengths_nm_, arena_)) {}

SampledSpectrum ExportedBsdf::At::operator()(const Vec3& light, const Vec3& seen) const {
  // An exact f uses no random numbers.
  RandomStream unused(0);
  return bsdf_.f(seen, light, unused);
}

std::vector<std::vector<double>> split_into_lanes(const std::vector<double>& wavelengths_nm) {
  std::vector<std::vector<double>> runs;
  for (const double nm : wavelengths_nm) {
    if (runs.empty() || runs.back().size() == kLanes) runs.emplace_back();
    runs.back().push_back(nm);
  }
  return runs;
}

const ParsedParam* fluorescence_of(const ParsedPlugin& leaf) {
  for (const ParsedParam& given : leaf.params) {
    const leaf::LeafNumber* number = leaf::find_leaf_number(given.name);
    const auto* values = std::get_if<std::vector<double>>(&given.values);
    const bool is_yield =
        number && number->action == leaf::LeafAction::emission && !(values && *values == std::vector{0.0});
    if (is_yield || given.name == "fluorescencematrices") return &given;
  }
  return nullptr;
}

}  // namespace frond
