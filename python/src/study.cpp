#include "study/compare/study.h"

#include "common.h"
#include "study/compare/measure.h"

namespace frond::python {
namespace {

/// Ends a study, which takes no token, by an exception.
class StopByProgress final : public Progress {
 public:
  explicit StopByProgress(const RenderControl& control) : control_(control) {}
  void update(double fraction, const RenderStatistics& so_far) override {
    if (control_.stop.stop_requested()) throw std::runtime_error("stopped");
    control_.progress->update(fraction, so_far);
  }

 private:
  const RenderControl& control_;
};

}  // namespace

void bind_study(nb::module_& m) {
  using namespace nb::literals;
  m.def(
      "compare",
      [](const std::shared_ptr<SessionHandle>& owner, const std::string& scene, const std::vector<std::string>& models,
         const std::string& reference, const std::string& wavelengths, int size, uint64_t samples,
         uint64_t reference_samples, const nb::object& progress) {
        std::optional<compare::Comparison> found;
        run(
            [&](const RenderControl& control) {
              Session& session = owner->session;
              StopByProgress progress_or_stop(control);
              const compare::Study study(session, {.scene = scene, .wavelengths = wavelengths, .size = size});
              compare::Plan plan{.reference = compare::parse_candidate(reference),
                                 .candidates = compare::parse_candidates(models)};
              plan.top_samples = samples, plan.reference_samples = reference_samples;
              plan.progress = &progress_or_stop;
              found = compare::measure(study, plan, {});
            },
            progress);
        nb::list rows;
        for (const compare::Subject& subject : found->subjects)
          for (const compare::Rung& rung : subject.rungs)
            for (const auto region : {compare::kAll, compare::kLeaf}) {
              if (rung.errors[region].empty()) continue;
              const RenderError& e = rung.errors[region][compare::kTogether];
              nb::dict row;
              row["model"] = subject.candidate.label, row["region"] = compare::kRegionNames[region];
              row["samples"] = rung.samples, row["cpu_seconds"] = rung.cost.cpu_seconds;
              row["setup_cpu_seconds"] = subject.setup_cpu_seconds;
              row["rmse"] = e.total.root(), row["noise"] = e.noise.root(), row["bias"] = e.bias.root();
              rows.append(row);
            }
        return rows;
      },
      "session"_a, "scene"_a, "models"_a, "reference"_a, "wavelengths"_a, "size"_a, "samples"_a, "reference_samples"_a,
      "progress"_a.none());
}

}  // namespace frond::python
