#include "materials/leaf_params.h"

#include <algorithm>

#include "core/material.h"
#include "core/messages/excerpt.h"
#include "leaf/tissue/absorption.h"
#include "leaf/tissue/constants.h"
#include "leaf/tissue/specimen_file.h"
#include "spectra/check_range.h"
#include "spectra/spd_file.h"

namespace frond {

using leaf::LeafNumber;
using leaf::TissueParams;

namespace {

constexpr std::string_view kAbsorption[] = {"baranoski", "prospect"};
constexpr std::string_view kMatrixUnits[] = {"photons", "energy"};
constexpr std::string_view kIncident[] = {"traced", "light", "reciprocal"};

// clang-format off
constexpr Param kSpecimen{
    .name = "specimen", .kind = ParamKind::string, .default_value = std::string_view("soybean"),
    .doc = "Named set of leaf parameters, from the literature or fitted to measurements (frond list specimens): the "
           "structure, and the parameters that are not given.", .choices = leaf::kSpecimenNames};
constexpr Param kSpecimenFile{
    .name = "specimenfile", .kind = ParamKind::string,
    .doc = "Leaf of a specimen file instead of a named specimen, as in leaves.csv:LEAF (frond fit --specimens; "
           "docs/file_formats.md).", .in_place_of_others = true};
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
    {.name = "fluorescencematrices", .kind = ParamKind::string,
     .doc = "File with the leaf's excitation-emission matrices Mb and Mf (docs/file_formats.md): Lambertian emission, "
            "whatever the angle of incidence. It replaces the fluorescence of the model and its yield."},
    {.name = "fluorescenceunit", .kind = ParamKind::string, .default_value = kMatrixUnits[0],
     .doc = "What these matrices hold, for each nm of emission. photons: photons per incident photon; energy: energy "
            "per incident energy.", .choices = kMatrixUnits},
    {.name = "fluorescencescale", .kind = ParamKind::real, .default_value = 1.0, .range = {0, 1e6},
     .doc = "Factor of these matrices: the quantum yield if they hold for a yield of 1; 0.2 if the sum over steps of "
            "5 nm is part of them."},
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

/// A named leaf, with its parameters.
std::pair<std::string, TissueParams> specimen_of(const Params& p) {
  if (!p.given("specimenfile")) return {p.string("specimen"), leaf::find_specimen(p.string("specimen"))->params};
  if (p.given("specimen")) fail(p.where("specimen"), "\"specimen\" has no effect beside \"specimenfile\"");
  const std::filesystem::path path = p.file("specimenfile");
  const auto [file, name] = spectrum_column(path);
  if (is_foreign(path)) mark_foreign(file);
  return {spectrum_name(path), leaf::read_specimen(file, name, p.where("specimenfile"))};
}

leaf::EmissionShape emission_of(const Params& p) {
  if (!p.given("emission")) return {};
  const std::filesystem::path file = p.file("emission");
  return {spectrum_name(file), read_spd_points(file, p.where("emission")), p.where("emission")};
}

std::shared_ptr<const leaf::EmissionMatrices> matrices_of(const Params& p) {
  constexpr std::string_view kName = "fluorescencematrices";
  if (!p.given(kName)) {
    for (const char* name : {"fluorescenceunit", "fluorescencescale"})
      if (p.given(name)) fail(p.where(name), "\"{}\" has no effect without \"{}\"", name, kName);
    return nullptr;
  }
  const leaf::MatrixUnit unit{p.string("fluorescenceunit") == "energy", p.real("fluorescencescale")};
  return std::make_shared<const leaf::EmissionMatrices>(
      leaf::read_emission_matrices(p.file(kName), unit, p.where(kName)));
}

}  // namespace

const std::vector<Param>& leaf_params() {
  static const std::vector<Param> params = [] {
    std::vector<Param> all{kSpecimen, kSpecimenFile};
    for (const LeafNumber& n : leaf::leaf_parameters())
      if (n.acts_by_depth()) all.push_back(param_of(n));
    all.push_back(kTables);
    for (const bool takes_texture : {false, true})
      for (const LeafNumber& n : leaf::leaf_parameters())
        if (!n.acts_by_depth() && n.takes_texture == takes_texture) all.push_back(param_of(n));
    all.insert(all.end(), std::begin(kOthers), std::end(kOthers));
    for (const leaf::PlateNumber& n : leaf::plate_numbers())
      all.push_back({.name = n.name,
                     .kind = ParamKind::real,
                     .unit = n.unit,
                     .range = n.range,
                     .doc = n.doc,
                     .in_place_of_others = true});
    return all;
  }();
  return params;
}

bool is_of_tissue(const Param& leaf_param) {
  constexpr std::string_view kOfNone[] = {"specimen",         "specimenfile",     "incident", "fluorescencematrices",
                                          "fluorescenceunit", "fluorescencescale"};
  const LeafNumber* n = leaf::find_leaf_number(leaf_param.name);
  return n ? n->action != leaf::LeafAction::surface : std::ranges::find(kOfNone, leaf_param.name) == std::end(kOfNone);
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

std::optional<leaf::PlateLeaf> plate_leaf(const Params& p) {
  if (find_param(p.info(), LeafModel::kTableFile) && p.given(LeafModel::kTableFile)) return std::nullopt;
  const std::span<const leaf::PlateNumber> numbers = leaf::plate_numbers();
  const auto first = std::ranges::find_if(numbers, [&p](const auto& n) { return p.given(n.name); });
  if (first == numbers.end()) return std::nullopt;
  leaf::PlateLeaf leaf;
  std::string needed;
  for (const leaf::PlateNumber& n : numbers) {
    if (n.is_needed) needed += fmt::format("{}{}", needed.empty() ? "" : ", ", n.name);
    leaf.values.push_back(p.given(n.name) ? p.real(n.name) : 0);
  }
  for (const leaf::PlateNumber& n : numbers)
    if (n.is_needed && !p.given(n.name))
      fail(p.where(first->name), "a leaf of PROSPECT needs \"{}\" too: {}", n.name, needed);
  return leaf;
}

LeafParams::LeafParams(const Params& p, Plates plates)
    : where_(p.where()),
      pigments_where_(p.where("pigments")),
      incident_(incident_of(p.string("incident"))),
      plates_(plate_leaf(p)),
      depth_(read(p, plates)),
      emission_(emission_of(p)),
      matrices_(matrices_of(p)) {}

/// Whether PROSPECT's parameters describe what the parameter does: all of R and T, and not the emission.
static bool is_replaced_by_plates(const Param& of_leaf) {
  if (const LeafNumber* n = leaf::find_leaf_number(of_leaf.name)) return n->changes_shares();
  return is_of_tissue(of_leaf) && !leaf::find_plate_number(of_leaf.name) && of_leaf.name != "emission";
}

leaf::DepthMap LeafParams::read(const Params& p, Plates plates) {
  // Starts from the specimen's parameters, which those of the scene replace.
  std::tie(specimen_, tissue_) = specimen_of(p);
  if (plates_) {
    for (const Param& of_leaf : leaf_params())
      if (is_replaced_by_plates(of_leaf) && p.given(of_leaf.name))
        fail(p.where(of_leaf.name),
             "\"{}\" has no effect beside PROSPECT's parameters, which are those of the whole leaf", of_leaf.name);
    if (plates == Plates::walk) {
      const double cuticle_aspect = tissue_.cuticle_aspect;  // which R and T do not determine
      tissue_ = leaf::nearest_walk(*plates_).params;
      tissue_.cuticle_aspect = cuticle_aspect;
    }
  }
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
  if (tissue_.fluorescence > 0 && !is_constant())
    fail(where_, "the fluorescence of a leaf with textures is not computed: give its parameters as numbers");
}

void LeafParams::check_wavelengths(const WavelengthStrategy& wavelengths) const {
  check_range(leaf::kConstantsRange_nm, wavelengths, where_, "leaf optics");
  for (const auto& [file, range_nm] : pigment_data_) check_range(range_nm, wavelengths, pigments_where_, file);
}

void LeafParams::log_difference(const Log& log) const {
  if (!plates_) return;
  const leaf::NearestWalk& walk = leaf::nearest_walk(*plates_);
  log.info(fmt::format("leaf of PROSPECT: R and T of the walk differ by {:.4f} (RMS), at most {:.4f} (at {:g} nm)",
                       walk.rmse, walk.largest, walk.largest_nm));
}

}  // namespace frond
