#include "jobs/leaf/leaf_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "leaf/solve/solver.h"
#include "materials/leaf_params.h"
#include "report/fit_report.h"

namespace frond {
namespace {

/// Resolver for parameters that must be constants: it rejects textures and other references.
class NoReferences final : public ParamResolver {
 public:
  std::shared_ptr<const FloatTexture> float_texture(const std::string&, const Location&) override { reject(); }
  std::shared_ptr<const SpectrumTexture> spectrum_texture(const std::string&, const Location&) override { reject(); }
  std::shared_ptr<Material> material(const std::string&, const Location&) override { reject(); }
  SpectrumPtr spectrum(const ParsedParam&, SpectrumUse) override { reject(); }
  std::filesystem::path file(const std::string& name, const Location&) override { return name; }

 private:
  [[noreturn]] static void reject() { fail({}, "a leaf outside a scene requires constant parameters, not textures"); }
};

/// R and T of the solved walk where a spectrophotometer measures them.
std::vector<leaf::LeafMeasurement> solved_spectra(const leaf::TissueParams& tissue) {
  constexpr double kTheta_deg = 8, kFirst_nm = 400, kLast_nm = 2500, kStep_nm = 10;
  const leaf::TissueModel model(tissue);
  std::vector<leaf::LeafMeasurement> spectra;
  for (double nm = kFirst_nm; nm <= kLast_nm; nm += kStep_nm) {
    const leaf::Shares s = leaf::solve(model.at(nm), std::array{kTheta_deg})[0];
    spectra.push_back({nm, kTheta_deg, s.surface + s.subsurface, s.transmitted});
  }
  return spectra;
}

}  // namespace

Params constant_params(const PluginInfo& info, const PluginText& leaf) {
  ParsedPlugin plugin{std::string(info.name), {}, {}};
  set_params(leaf, info, {}, plugin);
  static NoReferences none;
  return Params(info, plugin, none);
}

std::string describe_leaf(const std::string& text, const Registry& registry) {
  const PluginText words = parse_plugin_text(text, {});
  const MaterialInfo& material = registry.materials.get(words.name, {});
  if (!material.leaf) fail({}, "\"{}\" is no leaf: frond describe {} prints its parameters", words.name, words.name);
  const Params params = constant_params(material, words);
  const LeafParams leaf(params);
  const leaf::TissueParams& tissue = leaf.tissue();
  std::string out = text + "\n";
  if (const auto plates = plate_leaf(params)) {
    const leaf::NearestWalk& walk = leaf::nearest_walk(*plates);
    out += fmt::format(
        "parameters of the nearest walk, whose R and T differ by {:.4f} (RMS), at most {:.4f} (at {:g} nm)\n",
        walk.rmse, walk.largest, walk.largest_nm);
  } else {
    out += "parameters\n";
  }
  for (const leaf::LeafNumber& n : leaf::leaf_parameters())
    if (n.changes_shares() && leaf::has_number(tissue.structure, n))
      out += number_line(n.name, n.value(tissue), n.unit);
  out += "per leaf area\n";
  for (const leaf::AreaContent& c : leaf::area_contents())
    out += number_line(c.name, leaf::area_content(tissue, c) * c.unit.per_kg_per_m2, c.unit.name);
  // Of a leaf that PROSPECT's numbers gave, these are close to them, as the walk is.
  if (const auto fitted = leaf::fit_plates(solved_spectra(tissue))) out += plates_text(*fitted);
  return out;
}

void log_walk_of_plates(const std::string& text, const Registry& registry, const Log& log) {
  const PluginText words = parse_plugin_text(text, {});
  const MaterialInfo* material = registry.materials.find(words.name);
  const bool is_of_plates =
      std::ranges::any_of(words.params, [](const auto& p) { return leaf::find_plate_number(p.first) != nullptr; });
  if (!is_of_plates || !material || !material->leaf || material->leaf->table == LeafModel::Table::shares) return;
  LeafParams(constant_params(*material, words)).log_difference(log);
}

}  // namespace frond
