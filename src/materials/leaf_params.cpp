#include "materials/leaf_params.h"

#include "leaf/tissue/absorption.h"
#include "leaf/tissue/constants.h"
#include "spectra/check_range.h"
#include "spectra/spd_file.h"

namespace frond {

using leaf::TissueParams;

namespace {

Incident incident_of(std::string_view word) {
  if (word == "reciprocal") return Incident::reciprocal;
  return word == "light" ? Incident::light : Incident::traced;
}

}  // namespace

LeafParams::LeafParams(const Params& p)
    // Starts from the specimen's parameters; `read` replaces those that the scene gives.
    : specimen_(p.string("specimen")),
      where_(p.where()),
      pigments_where_(p.where("pigments")),
      tissue_(leaf::find_specimen(specimen_)->params),
      incident_(incident_of(p.string("incident"))),
      depth_(read(p)) {}

leaf::DepthMap LeafParams::read(const Params& p) {
  Varying varying;
  /// Sets a parameter; returns its texture if that varies over the leaf.
  const auto replace = [&p, this](double TissueParams::*number, std::string_view name) -> Aspect {
    if (!p.given(name)) return nullptr;
    if (!p.is_texture(name)) {
      tissue_.*number = p.real(name);
      return nullptr;
    }
    const auto texture = p.float_texture(name);
    // The largest value bounds the depth; DepthMap evaluates the texture itself.
    tissue_.*number = texture->range().max;
    return texture->is_constant() ? nullptr : texture;
  };
  struct Named {
    double TissueParams::*number;
    std::string_view name;
  };
  for (const auto& [number, name] :
       {Named{&TissueParams::thickness_m, "thickness"}, Named{&TissueParams::mesophyll_fraction, "mesophyllfraction"},
        Named{&TissueParams::chlorophyll_a, "chlorophylla"}, Named{&TissueParams::chlorophyll_b, "chlorophyllb"},
        Named{&TissueParams::carotenoids, "carotenoids"}, Named{&TissueParams::protein, "protein"},
        Named{&TissueParams::cellulose, "cellulose"}, Named{&TissueParams::lignin, "lignin"},
        Named{&TissueParams::anthocyanins, "anthocyanins"}, Named{&TissueParams::brown_pigments, "brownpigments"},
        Named{&TissueParams::dry_matter, "drymatter"}, Named{&TissueParams::other_absorption, "otherabsorption"}})
    if (auto texture = replace(number, name))
      varying.push_back({[number = number](TissueParams& t) -> double& { return t.*number; }, std::move(texture)});
  aspects_ = {replace(&TissueParams::cuticle_aspect, "cuticleaspect"),
              replace(&TissueParams::epidermis_aspect, "epidermisaspect"),
              replace(&TissueParams::spongy_aspect, "spongyaspect"),
              replace(&TissueParams::palisade_aspect, "palisadeaspect")};
  if (p.given("absorption"))
    tissue_.absorption_tables =
        p.string("absorption") == "prospect" ? leaf::AbsorptionTables::prospect : leaf::AbsorptionTables::baranoski;
  if (p.given("spongyshare")) tissue_.spongy_share = p.real("spongyshare");
  if (p.given("cuticlerefractivity")) tissue_.cuticle_refractivity = p.real("cuticlerefractivity");
  if (p.given("sieve")) tissue_.sieve_and_detour = p.boolean("sieve");
  read_pigments(p, varying);
  return {tissue_, varying};
}

void LeafParams::read_pigments(const Params& p, Varying& varying) {
  // Beyond a file's range its first or last value is used here; check_wavelengths rejects such renders.
  const auto files = p.files("pigments");
  const auto concentrations = p.float_textures("pigmentconcentrations");
  if (files.size() != concentrations.size())
    fail(p.where(files.size() < concentrations.size() ? "pigmentconcentrations" : "pigments"),
         "{} pigments have {} concentrations: one for each is needed", files.size(), concentrations.size());
  for (size_t i = 0; i < files.size(); ++i) {
    const SpectrumPtr spectrum = read_spd(files[i], pigments_where_);
    pigment_data_.push_back({files[i].string(), spectrum->range_nm()});
    leaf::Pigment& pigment = tissue_.pigments.emplace_back();
    pigment.concentration = concentrations[i]->range().max;
    for (size_t k = 0; k < leaf::kAbsorptionGrid.size(); ++k)
      pigment.specific_absorption.push_back(double(spectrum->at(float(leaf::kAbsorptionGrid.nm(k)))));
    if (!concentrations[i]->is_constant())
      varying.push_back({[i](TissueParams& t) -> double& { return t.pigments[i].concentration; }, concentrations[i]});
  }
}

void LeafParams::refuse_wall_textures(const Params& p) const {
  struct Wall {
    std::string_view name;
    const Aspect& texture;
  };
  for (const auto& [name, texture] : {Wall{"epidermisaspect", epidermis_aspect()},
                                      Wall{"spongyaspect", spongy_aspect()}, Wall{"palisadeaspect", palisade_aspect()}})
    if (texture)
      fail(p.where(name), "{} takes no texture for \"{}\": each texel would need its own table; abm takes one",
           p.plugin(), name);
}

void LeafParams::check_wavelengths(const WavelengthStrategy& wavelengths) const {
  check_range(leaf::kConstantsRange_nm, wavelengths, where_, "leaf optics");
  for (const auto& [file, range_nm] : pigment_data_) check_range(range_nm, wavelengths, pigments_where_, file);
}

}  // namespace frond
