#include "leaf/fit/fit.h"

#include "common.h"
#include "leaf/fit/measured_spectra.h"
#include "leaf/tissue/constants.h"
#include "report/fit_report.h"

namespace frond::python {
namespace {

using namespace nb::literals;

struct FitHandle {
  leaf::FitRequest request;
  leaf::FitResult result;
  std::string source;
};

leaf::Structure structure_of(const std::string& word) {
  if (word == "bifacial") return leaf::Structure::bifacial;
  if (word == "unifacial") return leaf::Structure::unifacial;
  fail({}, "structure: \"{}\" is neither bifacial nor unifacial", word);
}

}  // namespace

void bind_fit(nb::module_& m) {
  m.def(
      "read_spectra",
      [](const std::string& path, const std::string& leaf, double theta_deg) {
        const leaf::MeasuredSpectra spectra = leaf::read_measured_spectra(path, {leaf, theta_deg});
        std::vector<std::tuple<double, double, std::optional<double>, std::optional<double>>> rows;
        for (const leaf::LeafReading& r : spectra.readings) rows.emplace_back(r.lambda_nm, r.theta_deg, r.r, r.t);
        return rows;
      },
      "path"_a, "leaf"_a, "theta_deg"_a);
  m.def(
      "fit",
      [](const std::shared_ptr<SessionHandle>& owner,
         const std::vector<std::tuple<double, double, std::optional<double>, std::optional<double>>>& rows,
         const std::string& structure, std::optional<bool> sieve, const std::string& like,
         const std::vector<std::pair<std::string, double>>& fixed, const std::string& source) {
        auto fit = std::make_unique<FitHandle>();
        size_t values = 0;
        for (const auto& [nm, theta, r, t] : rows) {
          if (!leaf::kConstantsRange_nm.contains(nm))
            fail({}, "fit: {} nm is not within {} to {} nm", nm, leaf::kConstantsRange_nm.min,
                 leaf::kConstantsRange_nm.max);
          if (!(theta >= 0 && theta <= 180)) fail({}, "fit: an angle of {} degrees is not within 0 to 180", theta);
          if (!r && !t) continue;
          values += size_t(r.has_value()) + size_t(t.has_value());
          fit->request.readings.push_back({nm, theta, r, t});
        }
        if (!structure.empty()) fit->request.structure = structure_of(structure);
        fit->request.sieve = sieve;
        if (!like.empty()) {
          fit->request.like = leaf::find_specimen(like);
          if (!fit->request.like) fail({}, "fit: there is no specimen \"{}\"", like);
          fit->request.has_prior = true;
          if (structure.empty()) fit->request.structure = fit->request.like->params.structure;
        }
        for (const auto& [name, value] : fixed) {
          const bool is_known =
              name == "mesophyllfraction" || name == "chlorophyllb" || name == "lignin" ||
              std::ranges::find(leaf::kFitVariables, name, &leaf::FitVariable::name) != std::end(leaf::kFitVariables);
          if (!is_known) fail({}, "fit: \"{}\" is no number of a leaf that is fitted", name);
          fit->request.fixed.push_back({name, value});
        }
        const size_t all = std::size(leaf::kFitVariables), free = all - std::min(all, fixed.size());
        if (values == 0 || (values < free && like.empty()))
          fail({}, "fit: {} values are fewer than the {} numbers to fit: fix some, or say what the leaf is like",
               values, free);
        fit->source = source;
        const nb::gil_scoped_release release;
        fit->result = leaf::fit_leaf(fit->request, owner->session.pool());
        return fit;
      },
      "session"_a, "rows"_a, "structure"_a, "sieve"_a.none(), "like"_a, "fixed"_a, "source"_a);

  nb::class_<FitHandle>(m, "Fit")
      .def("json",
           [](const FitHandle& f) {
             return fit_json({f.request, f.result, f.source, "leaf"});
           })
      .def("text",
           [](const FitHandle& f) {
             return fit_text({f.request, f.result, f.source, "leaf"});
           })
      .def(
          "scene",
          [](const FitHandle& f, const std::string& material) {
            return fit_scene({f.request, f.result, f.source, material});
          },
          "material"_a);
}

}  // namespace frond::python
