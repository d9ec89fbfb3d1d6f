#include "common.h"
#include "instruments/given_wavelengths.h"
#include "leaf/table/body_cache.h"
#include "leaf/table/portable_leaf.h"
#include "leaf/table/reciprocal_body.h"
#include "leaf/tissue/absorption.h"
#include "leaf/tissue/constants.h"
#include "materials/leaf_params.h"
#include "render/material_words.h"
#include "render/refusing_log.h"
#include "scene/resolver.h"

namespace frond::python {
namespace {

using namespace nb::literals;

LeafParams leaf_of(SessionHandle& owner, const std::vector<std::string>& words) {
  const Registry& registry = owner.session.registry();
  const MaterialWords material = parse_material(words, registry);
  SceneDescription description = scene_of_materials(registry);
  const RefusingLog refusing;
  const GivenWavelengths any({551});
  SceneResolver resolver(description, registry, any, refusing);
  return LeafParams(Params(material.info, material.plugin, resolver));
}

/// Steps of the logarithm of depth, as leaf_solved has them (materials/leaf_solved.cpp).
constexpr double kDepthStep = 0.15;

nb::dict leaf_table(const std::shared_ptr<SessionHandle>& owner, const std::vector<std::string>& words,
                    const std::vector<double>& wavelengths_nm, double tolerance,
                    const std::optional<std::pair<double, double>>& depths) {
  leaf::PortableLeaf table;
  {
    const nb::gil_scoped_release release;
    const LeafParams leaf = leaf_of(*owner, words);
    if (leaf.incident() == Incident::light)
      fail({},
           "leaf_table: incident is \"traced\" or \"reciprocal\"; of \"light\" the former with its directions in turn");
    if (wavelengths_nm.empty() || !std::ranges::is_sorted(wavelengths_nm))
      fail({}, "leaf_table: wavelengths are one at least, and ascend");
    for (const double nm : wavelengths_nm) leaf.check_wavelengths(GivenWavelengths({float(nm)}));
    leaf::BodyRequest request{.params = leaf.tissue(),
                              .wavelengths_nm = wavelengths_nm,
                              .tolerance = leaf.is_reciprocal() ? tolerance / leaf::kReciprocalFiner : tolerance};
    request.params.cuticle_aspect = 0;
    if (depths) {
      if (!(0 <= depths->first && depths->first < depths->second))
        fail({}, "leaf_table: depths from {} to {} are no range", depths->first, depths->second);
      request.depths = leaf::DepthAxis(depths->first, depths->second, kDepthStep);
    }
    Session& session = owner->session;
    leaf::BodySpectrum spectrum =
        leaf::cached_body_spectrum(request, leaf.specimen(), session.pool(), session.log(), owner->options.cache);
    if (leaf.is_reciprocal()) spectrum = leaf::make_reciprocal(spectrum).value();
    table = leaf::make_portable(request, spectrum, leaf.tissue().cuticle_aspect);
  }
  nb::dict d;
  const std::string bytes = leaf::portable_bytes(table);
  d["bytes"] = nb::bytes(bytes.data(), bytes.size());
  d["reciprocal"] = table.is_reciprocal, d["cells"] = table.cells, d["exponent"] = table.exponent;
  const size_t side = table.side(), columns = table.columns();
  d["wavelength_nm"] = to_array(table.wavelengths_nm, {table.wavelengths_nm.size()});
  d["depth"] = to_array(table.depths, {table.depths.size()});
  d["index"] = to_array(table.index, {table.index.size()});
  constexpr size_t kCosines = leaf::PortableLeaf::kCosineCells + 1;
  d["surface"] = to_array(table.surface, {table.surface.size() / kCosines, kCosines});
  const char* sides[] = {"adaxial", "abaxial"};
  const char* crossing[] = {"reflected", "transmitted"};
  for (const bool below : {false, true}) {
    for (const bool crosses : {false, true})
      d[fmt::format("{}_{}", sides[below], crossing[crosses]).c_str()] =
          to_array(table.series[below][crosses], {columns, table.modes[below][crosses], side, side});
    d[fmt::format("{}_ways", sides[below]).c_str()] = to_array(table.ways[below], {columns, side, 2});
  }
  return d;
}

/// Specific absorption of what a leaf is made of, and how much of it there is.
nb::dict leaf_chemistry(const std::shared_ptr<SessionHandle>& owner, const std::vector<std::string>& words,
                        const std::vector<double>& wavelengths_nm) {
  const LeafParams leaf = leaf_of(*owner, words);
  const leaf::TissueParams& p = leaf.tissue();
  if (!p.pigments.empty()) fail({}, "leaf_chemistry: further pigments are none of its numbers");
  std::vector<double> chlorophyll, carotenoids, protein, cellulose, water;
  for (const double nm : wavelengths_nm) {
    if (!leaf::kConstantsRange_nm.contains(nm)) fail({}, "leaf_chemistry: {} nm is not within 360 to 2500 nm", nm);
    const leaf::Constants c = leaf::constants_at(nm);
    chlorophyll.push_back(c.chlorophyll), carotenoids.push_back(c.carotenoids), protein.push_back(c.protein);
    cellulose.push_back(c.cellulose), water.push_back(c.water);
  }
  const std::vector<size_t> shape{wavelengths_nm.size()};
  nb::dict absorption, amount;
  absorption["chlorophylla"] = to_array(chlorophyll, shape), absorption["chlorophyllb"] = to_array(chlorophyll, shape);
  absorption["carotenoids"] = to_array(carotenoids, shape), absorption["protein"] = to_array(protein, shape);
  absorption["cellulose"] = to_array(cellulose, shape), absorption["lignin"] = to_array(cellulose, shape);
  absorption["water"] = to_array(water, shape);
  absorption["otherabsorption"] = to_array(std::vector<double>(wavelengths_nm.size(), 1), shape);
  amount["chlorophylla"] = p.chlorophyll_a, amount["chlorophyllb"] = p.chlorophyll_b;
  amount["carotenoids"] = p.carotenoids, amount["protein"] = p.protein, amount["cellulose"] = p.cellulose;
  amount["lignin"] = p.lignin, amount["water"] = 1.0, amount["otherabsorption"] = p.other_absorption;
  nb::dict d;
  d["specific_absorption"] = absorption, d["amount"] = amount;
  d["thickness"] = p.thickness_m, d["mesophyllfraction"] = p.mesophyll_fraction;
  return d;
}

}  // namespace

void bind_leaf(nb::module_& m) {
  m.def("leaf_table", &leaf_table, "session"_a, "words"_a, "wavelengths"_a, "tolerance"_a, "depths"_a.none());
  m.def("leaf_chemistry", &leaf_chemistry, "session"_a, "words"_a, "wavelengths"_a);
}

}  // namespace frond::python
