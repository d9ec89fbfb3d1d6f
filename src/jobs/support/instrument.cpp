#include "jobs/support/instrument.h"

#include <algorithm>

#include "jobs/leaf/leaf_text.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "spectra/named.h"
#include "spectra/spd_file.h"

namespace frond {

MaterialsUnderTest::MaterialsUnderTest(const JobRun& run)
    : run_(run), as_rendered_(run.args.flag("rendered")), angles_deg_(run.args.numbers("angles")) {
  read_wavelengths();
  Session& session = run.session();
  for (const std::string& text : materials_of(run)) {
    materials_.emplace_back(text, session.registry(), lights_, session.pool(), run.log(), run.context.options().cache);
    log_walk_of_plates(text, session.registry(), run.log());
  }
  // Errors of any material and angle are reported before the first ray.
  Arena arena;
  for (size_t i = 0; i < size(); ++i) {
    const LitMaterial e = lit_material(i);
    arena.reset();
    bsdf_of(e.material, e.beam, arena);
    check_as_rendered(e);
  }
}

void MaterialsUnderTest::read_wavelengths() {
  constexpr Interval kKnown_nm{360, 2500};
  const Arguments& args = run_.args;
  const std::string option = args.spelled("wavelengths"), text = wavelengths_text(args);
  const auto add = [&](double nm, const InstrumentBand* band) {
    if (!kKnown_nm.contains(nm))
      fail({}, "{}: wavelengths from {:g} to {:g} (nm) are needed; {:g} was given", option, kKnown_nm.min,
           kKnown_nm.max, nm);
    lights_.push_back({0, nm, band});
  };
  if (const auto numbers = parse_numbers(args.text("wavelengths"))) {
    for (const double nm : *numbers) add(nm, nullptr);
  } else {
    SceneDescription description;
    set_wavelengths(description, text, {std::make_shared<const std::string>(option)});
    const auto strategy = make_wavelengths(description, run_.session().registry());
    if (strategy->bands().empty())
      fail({}, "{}: \"{}\" is for images of colours: an instrument needs wavelengths, as in 450,550 or 400:700:10",
           option, text);
    bands_.reserve(strategy->bands().size());  // lights point to them
    for (const Band& band : strategy->bands())
      add(band.nm, band.response.empty() ? nullptr : &bands_.emplace_back(lit_band(band)));
  }
  if (bands_.empty() && args.given("illuminant"))
    run_.log().warn({}, fmt::format("{} has no effect on single wavelengths", args.spelled("illuminant")));
}

/// Throws InputError for an illuminant that is unknown or 0 in the band.
InstrumentBand MaterialsUnderTest::lit_band(const Band& band) const {
  const std::string option = run_.args.spelled("illuminant"), light = run_.args.text("illuminant");
  const SpectrumPtr illuminant = named_or_read_spectrum(light, light, {});
  const Interval needed{band.response.front().nm, band.response.back().nm}, known = illuminant->range_nm();
  if (!(known.contains(needed.min) && known.contains(needed.max)))
    fail({}, "{}: \"{}\" is known from {:g} to {:g} nm, band {} needs {:g} to {:g} nm", option, light, known.min,
         known.max, band.name, needed.min, needed.max);
  const auto lit = lit_response(band.response, *illuminant);
  if (lit.empty()) fail({}, "{}: \"{}\" is 0 in band {}", option, light, band.name);
  return {band.name, ResponseSampler(lit, {})};
}

std::string MaterialsUnderTest::illuminant_line() const {
  return bands_.empty() ? "" : "Bands are weighted by response and illuminant: " + run_.args.text("illuminant");
}

void check_wavelengths_are_given(const JobRun& run) {
  if (!run.args.given("wavelengths"))
    fail({}, "{} is needed: {}", run.args.spelled("wavelengths"), kInstrumentWavelengthsParam.doc);
}

void add_light(Table& table, const Beam& beam) {
  if (beam.band) table.add("band", beam.band->name);
  table.add(beam.emission_nm > 0 ? "excitation_nm" : "wavelength_nm", beam.lambda_nm);
  if (beam.emission_nm > 0) table.add("emission_nm", beam.emission_nm);
}

/// The seed depends on the material's text, so that adding a material does not change the results of others.
LitMaterial MaterialsUnderTest::lit_material(size_t i) const {
  const size_t light = i % lights_.size(), angle = i / lights_.size() % angles_deg_.size();
  const MeasuredMaterial& m = material(i);
  return {m.at(light),
          {angles_deg_[angle], lights_[light].lambda_nm, lights_[light].band},
          hash_key(run_.args.seed("seed"), m.seed()),
          as_rendered_};
}

/// `rays_each` is the largest number of rays of a measurement; the fraction is a lower bound with --se.
RayProgress MaterialsUnderTest::progress(size_t i, int64_t rays_each) const {
  return [this, i, rays_each](int64_t rays) {
    run_.check_stop();
    if (!run_.control.progress) return;
    RenderStatistics so_far;
    so_far.rays = so_far.paths = i * uint64_t(rays_each) + uint64_t(rays);
    so_far.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    run_.control.progress->update(double(so_far.rays) / (double(size()) * double(rays_each)), so_far);
  };
}

std::vector<std::string> MaterialsUnderTest::notes(std::string_view instrument) const {
  std::vector<std::string> notes{fmt::format("frond {} {}", FROND_VERSION, instrument)};
  for (const MeasuredMaterial& m : materials_) notes.push_back("material: " + m.label());
  notes.push_back(fmt::format("seed: {}", run_.args.seed("seed")));
  notes.push_back(
      as_rendered_
          ? "As rendered: light arrives along wi and leaves along wo, whichever of them the model takes as incident."
          : "Light comes in along the direction that the material's model calls incident, whatever its "
            "\"incident\" says.");
  if (!bands_.empty()) notes.push_back(illuminant_line());
  if (std::ranges::count(angles_deg_, 90) > 0)
    notes.push_back(
        "At 90 degrees light meets neither side: that figure is the limit from the front, cos theta = 1e-7.");
  return notes;
}

}  // namespace frond
