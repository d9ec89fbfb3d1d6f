#include "study/compare/paper_manner.h"

#include <algorithm>
#include <cmath>

namespace frond::compare {
namespace {

void set(PluginText& text, const std::string& name, const std::string& value) {
  std::erase_if(text.params, [&name](const auto& p) { return p.first == name; });
  text.params.emplace_back(name, value);
}

std::string text_of(const PluginText& plugin) {
  std::string text = plugin.name;
  for (const auto& [name, value] : plugin.params) text += fmt::format(",{}={}", name, value);
  return text;
}

std::string text_of(const Candidate& c) {
  return text_of(c.material) + (c.wavelengths.empty() ? "" : "@wavelengths=" + c.wavelengths) +
         "@integrator=" + text_of(*c.integrator);
}

/// Returns the candidate with an integrator that ends paths by attenuation, cutoff and depth unset; nullopt if its
/// integrator lacks these parameters.
std::optional<Candidate> ended_by_attenuation(Candidate c, const Study& study) {
  if (!c.integrator) c.integrator = PluginText{study.integrator_name(), {}};
  const IntegratorInfo& integrator = study.registry().integrators.get(c.integrator->name, {});
  for (const char* needed : {"termination", "cutoff", "maxdepth"})
    if (!find_param(integrator, needed)) return {};
  set(*c.integrator, "termination", "attenuation");
  if (find_param(study.registry().materials.get(c.material.name, {}), "surfacedirect"))
    set(c.material, "surfacedirect", "false");
  return c;
}

PluginText with_termination(PluginText integrator, double cutoff, double depth) {
  set(integrator, "cutoff", fmt::format("{:.3g}", cutoff));
  set(integrator, "maxdepth", fmt::format("{:.0f}", std::ceil(depth)));
  return integrator;
}

/// Renders a candidate with a series of cutoffs.
class CutoffRenders {
 public:
  CutoffRenders(const Study& study, const Candidate& candidate, uint64_t samples)
      : study_(study),
        samples_(samples),
        integrator_(*candidate.integrator),
        scene_(study.scene(candidate)),
        sampler_(study.sampler(*scene_, study.seed())) {}

  PathEnds measure_path_ends(double cutoff) const {
    const auto integrator = study_.integrator(*scene_, with_termination(integrator_, cutoff, PathEnds::kDepths - 1));
    Film film({.settings = study_.film(), .bands = scene_->wavelengths().bands().size()});
    const RenderInputs job = job_of(*scene_, *integrator, *sampler_);
    return render(job, plan_of(film, {0, samples_}), film, study_.session().pool()).ends;
  }

 private:
  const Study& study_;
  uint64_t samples_;
  PluginText integrator_;
  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<Sampler> sampler_;
};

}  // namespace

PaperManner::PaperManner(const Study& study, const Candidate& baseline, uint64_t pilot_samples)
    : study_(study), pilot_samples_(pilot_samples) {
  const auto candidate = ended_by_attenuation(baseline, study);
  if (!candidate) return;
  const PathEnds ends = CutoffRenders(study, *candidate, pilot_samples).measure_path_ends(kPaperCutoff);
  depth_ = depth_of_trees(ends);
  target_ = unshot_ratio(ends, depth_);
}

std::optional<PaperTiming> PaperManner::timing(const Candidate& candidate) const {
  auto c = ended_by_attenuation(candidate, study_);
  if (!c || depth_ == 0) return {};
  const CutoffRenders pilot(study_, *c, pilot_samples_);
  const CutoffFit end =
      fit_cutoff(target_, [&](double cutoff) { return unshot_ratio(pilot.measure_path_ends(cutoff), depth_); });
  c->integrator = with_termination(*c->integrator, end.cutoff, depth_);
  c->text = text_of(*c);
  return PaperTiming{*c, depth_, end};
}

}  // namespace frond::compare
