#include "jobs/support/instrument.h"

#include <algorithm>

namespace frond {

MaterialsUnderTest::MaterialsUnderTest(const JobRun& run)
    : run_(run),
      as_rendered_(run.args.flag("rendered")),
      angles_deg_(run.args.numbers("angles")),
      wavelengths_nm_(run.args.numbers("wavelengths")) {
  Session& session = run.session();
  for (const std::string& text : materials_of(run))
    materials_.emplace_back(text, session.registry(), wavelengths_nm_, session.pool(), run.log(),
                            run.context.options().cache);
  // Errors of any material and angle are reported before the first ray.
  Arena arena;
  for (size_t i = 0; i < size(); ++i) {
    const LitMaterial e = lit_material(i);
    arena.reset();
    bsdf_of(e.material, e.beam, arena);
    check_as_rendered(e);
  }
}

/// The seed depends on the material's text, so that adding a material does not change the results of others.
LitMaterial MaterialsUnderTest::lit_material(size_t i) const {
  const size_t wavelength = i % wavelengths_nm_.size(), angle = i / wavelengths_nm_.size() % angles_deg_.size();
  const MeasuredMaterial& m = material(i);
  return {m.at(wavelength),
          {angles_deg_[angle], wavelengths_nm_[wavelength]},
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
  if (std::ranges::count(angles_deg_, 90) > 0)
    notes.push_back(
        "At 90 degrees light meets neither side: that figure is the limit from the front, cos theta = 1e-7.");
  return notes;
}

}  // namespace frond
