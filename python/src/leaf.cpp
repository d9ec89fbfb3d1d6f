#include "common.h"
#include "instruments/given_wavelengths.h"
#include "leaf/fit/measured_spectra.h"
#include "leaf/plates/plate_leaf.h"
#include "leaf/tissue/absorption.h"
#include "materials/leaf_file.h"
#include "render/measured_material.h"
#include "scene/resolver.h"
#include "system/atomic_file.h"

namespace frond::python {
namespace {

using namespace nb::literals;

LeafParams leaf_of(SessionHandle& owner, const std::string& material) {
  const Registry& registry = owner.session().registry();
  const MaterialWords words = parse_material(material_text({material}), registry);
  if (!find_param(words.info, "specimen")) fail({}, "\"{}\" is no leaf: leaf_solved is needed", words.info.name);
  SceneDescription description = scene_of_materials(registry);
  const RefusingLog refusing;
  const GivenWavelengths any({551});
  SceneResolver resolver(description, registry, any, refusing);
  return LeafParams(Params(words.info, words.plugin, resolver));
}

nb::dict leaf_table(const std::shared_ptr<SessionHandle>& owner, const std::string& material,
                    const std::vector<double>& wavelengths_nm, double tolerance,
                    const std::optional<std::pair<double, double>>& depths) {
  leaf::LeafFile table;
  run(
      [&](const RenderControl& control) {
        const StopScope stop(control.stop);
        LeafFileRequest request{.wavelengths_nm = wavelengths_nm, .tolerance = tolerance};
        if (depths) request.depths = {depths->first, depths->second};
        table = make_leaf_file(leaf_of(*owner, material), std::move(request), owner->session().pool(),
                               owner->session().log(), owner->context.options().cache);
      },
      nb::none());
  nb::dict d;
  const std::string bytes = leaf::leaf_file_bytes(table);
  d["bytes"] = nb::bytes(bytes.data(), bytes.size());
  d["reciprocal"] = table.is_reciprocal, d["cells"] = table.cells, d["exponent"] = table.exponent;
  const size_t side = table.side(), columns = table.columns();
  d["wavelength_nm"] = to_array(table.wavelengths_nm, {table.wavelengths_nm.size()});
  d["depth"] = to_array(table.depths, {table.depths.size()});
  d["index"] = to_array(table.index, {table.index.size()});
  constexpr size_t kCosines = leaf::LeafFile::kCosineCells + 1;
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

/// Specific absorption and amount of each constituent of a leaf.
nb::dict leaf_chemistry(const std::shared_ptr<SessionHandle>& owner, const std::string& material,
                        const std::vector<double>& wavelengths_nm) {
  const LeafParams leaf = leaf_of(*owner, material);
  const leaf::TissueParams& p = leaf.tissue();
  if (!p.pigments.empty()) fail({}, "leaf_chemistry: further pigments are none of its numbers");
  for (const double nm : wavelengths_nm)
    if (!leaf::kConstantsRange_nm.contains(nm)) fail({}, "leaf_chemistry: {} nm is not within 360 to 2500 nm", nm);
  nb::dict absorption, amount, d;
  for (const leaf::LeafNumber& n : leaf::kLeafNumbers) {
    if (!n.absorbs()) continue;
    std::vector<double> specific;
    for (const double nm : wavelengths_nm) specific.push_back(leaf::specific_absorption(n, p.absorption_tables, nm));
    absorption[n.name.data()] = to_array(specific, {wavelengths_nm.size()}), amount[n.name.data()] = n.value(p);
  }
  d["specific_absorption"] = absorption, d["amount"] = amount;
  d["thickness"] = p.thickness_m, d["mesophyllfraction"] = p.mesophyll_fraction;
  return d;
}

}  // namespace

void bind_leaf(nb::module_& m) {
  m.def(
      "read_spectra",
      [](const std::string& path, const std::string& leaf, double theta_deg) {
        std::vector<std::tuple<double, double, std::optional<double>, std::optional<double>>> rows;
        for (const leaf::LeafMeasurement& r : leaf::read_measured_spectra(path, {leaf, theta_deg}).measurements)
          rows.emplace_back(r.lambda_nm, r.theta_deg, r.r, r.t);
        return rows;
      },
      "path"_a, "leaf"_a, "theta_deg"_a);
  m.def("leaf_table", &leaf_table, "session"_a, "material"_a, "wavelengths"_a, "tolerance"_a, "depths"_a.none());
  m.def(
      "replace_file",
      [](const std::string& path, const nb::bytes& bytes) {
        replace_file(path, {reinterpret_cast<const unsigned char*>(bytes.c_str()), bytes.size()});
      },
      "path"_a, "bytes"_a);
  // Names of a leaf's numbers, and how they act (leaf/tissue/leaf_numbers.h).
  m.def("leaf_numbers", [] {
    constexpr const char* kActions[] = {"length", "absorption", "structure", "surface", "emission"};
    std::vector<std::pair<const char*, const char*>> numbers;
    for (const leaf::LeafNumber& n : leaf::leaf_parameters())
      numbers.emplace_back(n.name.data(), kActions[static_cast<size_t>(n.action)]);
    return numbers;
  });
  // Names of PROSPECT's parameters of a leaf (leaf/plates/plate_leaf.h).
  m.def("plate_numbers", [] {
    std::vector<const char*> names;
    for (const leaf::PlateNumber& n : leaf::plate_numbers()) names.push_back(n.name.data());
    return names;
  });
  m.def("leaf_chemistry", &leaf_chemistry, "session"_a, "material"_a, "wavelengths"_a);
}

}  // namespace frond::python
