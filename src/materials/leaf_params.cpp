#include "materials/leaf_params.h"

#include <algorithm>

#include "leaf/tissue/absorption.h"
#include "leaf/tissue/constants.h"
#include "spectra/check_range.h"
#include "spectra/spd_file.h"

namespace frond {

using leaf::LeafNumber;
using leaf::TissueParams;

namespace {

constexpr std::string_view kAbsorption[] = {"baranoski", "prospect"};
constexpr std::string_view kIncident[] = {"traced", "light", "reciprocal"};

// clang-format off
constexpr Param kSpecimen{
    .name = "specimen", .kind = ParamKind::string, .default_value = std::string_view("soybean"),
    .doc = "Named set of leaf parameters, from the literature or fitted to measurements (frond list specimens): the "
           "structure, and the parameters that are not given.", .choices = leaf::kSpecimenNames};
constexpr Param kTables{
    .name = "absorption", .kind = ParamKind::string,
    .doc = "Specific absorption of chlorophylls, carotenoids and water. baranoski: as published with the model; "
           "prospect: as calibrated for PROSPECT-D; by default the specimen's.", .choices = kAbsorption};
constexpr Param kOthers[] = {
    {.name = "pigments", .kind = ParamKind::string,
     .doc = "Spectrum files (.spd, .csv) of the specific absorption of further pigments, in nm and m^2/kg.",
     .list = true},
    {.name = "pigmentconcentrations", .kind = ParamKind::float_texture, .unit = leaf::kMassPerVolume, .range = {0, 100},
     .doc = "Concentrations of these pigments in the mesophyll, one for each file.", .list = true},
    {.name = "fluorescingpigments", .kind = ParamKind::integer, .default_value = 0, .range = {0, 100},
     .doc = "Number of these pigments, from the first on, whose absorption excites fluorescence, as that of chlorophyll "
            "does."},
    {.name = "emission", .kind = ParamKind::string,
     .doc = "Spectrum file (.spd, .csv) of the fluorescence inside the tissue: wavelength in nm and density of photons, "
            "of any unit; by default two Gaussians (docs/fluorescence.md)."},
    {.name = "sieve", .kind = ParamKind::boolean,
     .doc = "Absorption with the sieve and detour effects (Baranoski and Eng 2007); by default the specimen's, which "
            "is false for soybean and maize."},
    {.name = "incident", .kind = ParamKind::string, .default_value = std::string_view("traced"),
     .doc = "Incident direction of the model, which is not reciprocal. traced: that of the traced ray, as published; "
            "light: that of the light; reciprocal: neither, the reciprocal BSDF closest to the model replaces it "
            "(docs/leaf_models.md).", .choices = kIncident},
};
// clang-format on

Param param_of(const LeafNumber& n) {
  return {.name = n.name,
          .kind = n.takes_texture ? ParamKind::float_texture : ParamKind::real,
          .unit = n.unit,
          .range = n.range,
          .doc = n.doc,
          .quantity = n.quantity};
}

Incident incident_of(std::string_view word) {
  if (word == "reciprocal") return Incident::reciprocal;
  return word == "light" ? Incident::light : Incident::traced;
}

leaf::EmissionShape emission_of(const Params& p) {
  if (!p.given("emission")) return {};
  const std::filesystem::path file = p.file("emission");
  return {spectrum_name(file), read_spd_points(file, p.where("emission")), p.where("emission")};
}

}  // namespace

const std::vector<Param>& leaf_params() {
  static const std::vector<Param> params = [] {
    std::vector<Param> all{kSpecimen};
    for (const LeafNumber& n : leaf::leaf_parameters())
      if (n.acts_by_depth()) all.push_back(param_of(n));
    all.push_back(kTables);
    for (const bool takes_texture : {false, true})
      for (const LeafNumber& n : leaf::leaf_parameters())
        if (!n.acts_by_depth() && n.takes_texture == takes_texture) all.push_back(param_of(n));
    all.insert(all.end(), std::begin(kOthers), std::end(kOthers));
    return all;
  }();
  return params;
}

bool is_of_tissue(const Param& leaf_param) {
  const LeafNumber* n = leaf::find_leaf_number(leaf_param.name);
  return n ? n->action != leaf::LeafAction::surface : leaf_param.name != "specimen" && leaf_param.name != "incident";
}

std::vector<Param> with_leaf_params(std::span<const Param> own) {
  std::vector<Param> all = leaf_params();
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

std::vector<Param> without_reciprocal(std::vector<Param> params) {
  for (Param& p : params)
    if (p.name == "incident") {
      p.doc =
          "Incident direction of the model, which is not reciprocal. traced: that of the traced ray, as published; "
          "light: that of the light.";
      p.choices = std::span(kIncident).first(2);
    }
  return params;
}

LeafParams::LeafParams(const Params& p)
    // Starts from the specimen's parameters; `read` replaces those that the scene gives.
    : specimen_(p.string("specimen")),
      where_(p.where()),
      pigments_where_(p.where("pigments")),
      tissue_(leaf::find_specimen(specimen_)->params),
      incident_(incident_of(p.string("incident"))),
      depth_(read(p)),
      emission_(emission_of(p)) {}

leaf::DepthMap LeafParams::read(const Params& p) {
  Varying varying;
  for (const LeafNumber& n : leaf::leaf_parameters()) {
    if (!p.given(n.name)) continue;
    if (!p.is_texture(n.name)) {
      n.value(tissue_) = p.real(n.name);
      continue;
    }
    const auto texture = p.float_texture(n.name);
    // The largest value bounds the depth; DepthMap evaluates the texture itself.
    n.value(tissue_) = texture->range().max;
    if (texture->is_constant()) continue;
    if (n.acts_by_depth())
      varying.push_back({[&n](TissueParams& t) -> double& { return n.value(t); }, texture});
    else
      aspects_.push_back({&n, texture});
  }
  if (p.given("absorption"))
    tissue_.absorption_tables =
        p.string("absorption") == "prospect" ? leaf::AbsorptionTables::prospect : leaf::AbsorptionTables::baranoski;
  if (p.given("sieve")) tissue_.sieve_and_detour = p.boolean("sieve");
  read_pigments(p, varying);
  return {tissue_, varying};
}

void LeafParams::read_pigments(const Params& p, Varying& varying) {
  // Beyond a file's range its first or last value is used here; check_wavelengths rejects such renders.
  const auto files = p.files("pigments");
  const auto concentrations = p.float_textures("pigmentconcentrations");
  const auto fluorescing = static_cast<size_t>(p.integer("fluorescingpigments"));
  if (files.size() != concentrations.size())
    fail(p.where(files.size() < concentrations.size() ? "pigmentconcentrations" : "pigments"),
         "{} pigments have {} concentrations: one for each is needed", files.size(), concentrations.size());
  for (size_t i = 0; i < files.size(); ++i) {
    const SpectrumPtr spectrum = read_spd(files[i], pigments_where_);
    pigment_data_.push_back({files[i].string(), spectrum->range_nm()});
    leaf::Pigment& pigment = tissue_.pigments.emplace_back();
    pigment.concentration = concentrations[i]->range().max;
    pigment.fluoresces = i < fluorescing;
    for (size_t k = 0; k < leaf::kAbsorptionGrid.size(); ++k)
      pigment.specific_absorption.push_back(double(spectrum->at(float(leaf::kAbsorptionGrid.nm(k)))));
    if (!concentrations[i]->is_constant())
      varying.push_back({[i](TissueParams& t) -> double& { return t.pigments[i].concentration; }, concentrations[i]});
  }
}

const LeafParams::Aspect& LeafParams::aspect(double TissueParams::*member) const {
  static const Aspect none;
  const auto found = std::ranges::find(aspects_, member, [](const auto& a) { return a.first->member; });
  return found == aspects_.end() ? none : found->second;
}

void LeafParams::reject_wall_textures(const Params& p) const {
  for (const auto& [number, texture] : aspects_)
    if (number->is_structure())
      fail(p.where(number->name), "{} takes no texture for \"{}\": each texel would need its own table; abm takes one",
           p.plugin(), number->name);
}

void LeafParams::refuse_varying_fluorescence() const {
  if (!is_constant())
    fail(where_, "the fluorescence of a leaf with textures is not computed: give its parameters as numbers");
}

void LeafParams::check_wavelengths(const WavelengthStrategy& wavelengths) const {
  check_range(leaf::kConstantsRange_nm, wavelengths, where_, "leaf optics");
  for (const auto& [file, range_nm] : pigment_data_) check_range(range_nm, wavelengths, pigments_where_, file);
}

}  // namespace frond
