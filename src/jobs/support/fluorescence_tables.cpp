#include "jobs/support/fluorescence_tables.h"

#include <fmt/ranges.h>

#include "instruments/fluorescence_matrix.h"
#include "jobs/record/common_params.h"
#include "render/measured_material.h"
#include "report/excitation_emission_chart.h"
#include "scene/leaf_models.h"

namespace frond {
namespace {

using Cell = FluorescenceMatrix::Cell;

/// Returns the names of the leaf models that have fluorescence: those whose mean is the random walk's.
std::string fluorescing_models(const Registry& registry) {
  std::vector<std::string_view> names;
  for (const MaterialInfo* model : leaf_models(registry))
    if (model->leaf->is_exact) names.push_back(model->name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Table with one row for each pair of wavelengths of each measurement.
Table matrix_table(const std::vector<LabelledMatrix>& matrices) {
  Table table{"measurements"};
  for (const auto& [material, m] : matrices)
    for (size_t e = 0; e < m.excitation_nm.size(); ++e)
      for (size_t f = 0; f < m.emission_nm.size(); ++f) {
        const Cell& cell = m.at(e, f);
        table.add("theta_deg", m.theta_deg);
        table.add("excitation_nm", m.excitation_nm[e]);
        table.add("emission_nm", m.emission_nm[f]);
        table.add("Mb", cell.lit_side.mean, cell.lit_side.standard_error());
        table.add("Mf", cell.opposite_side.mean, cell.opposite_side.standard_error());
        table.add("rays", double(m.rays));
        table.add("material", material);
      }
  table.document("theta_deg", "from the front's normal to the light, degrees; above 90 the back (abaxial side) is lit");
  table.document("Mb", "photons per nm of emission that leave the lit side, per incident photon, 1/nm");
  table.document("Mf", "photons per nm of emission that leave the other side, per incident photon, 1/nm");
  table.document("rays", "number of rays of light for this pair of wavelengths; 0: solved without noise");
  return table;
}

/// Table with one row for each wavelength of excitation: where the photons go, integrated over the emission.
Table balance_table(const std::vector<LabelledMatrix>& matrices) {
  Table table{"balance"};
  for (const auto& [material, m] : matrices)
    for (size_t e = 0; e < m.excitation_nm.size(); ++e) {
      Estimate absorbed;  // independent estimates of one number
      for (size_t f = 0; f < m.emission_nm.size(); ++f) absorbed += m.at(e, f).absorbed;
      const double count = double(m.emission_nm.size());
      // Appends the mean and the standard error of an integral.
      const auto add = [&](const char* name, Estimate Cell::*member) {
        const Estimate sum = m.integral(e, member);
        table.add(name, sum.mean, sum.standard_error());
        return sum.mean;
      };
      table.add("theta_deg", m.theta_deg);
      table.add("excitation_nm", m.excitation_nm[e]);
      table.add("absorbed", absorbed.mean / count, absorbed.standard_error() / count);
      const double emitted = add("emitted", &Cell::emitted), reabsorbed = add("reabsorbed", &Cell::reabsorbed),
                   lit = add("lit_side", &Cell::lit_side), other = add("other_side", &Cell::opposite_side);
      // Unknown (NaN) where matrices of a file are all that is known.
      table.add("escape", emitted == 0 ? 0 : (lit + other) / emitted);
      table.add("residual", emitted == 0 ? 0 : 1 - (reabsorbed + lit + other) / emitted);
      table.add("material", material);
    }
  table.document("absorbed", "photons that fluorescing constituents absorb, per incident photon");
  table.document("emitted", "photons emitted inside, per incident photon, over the wavelengths of emission");
  table.document("reabsorbed", "of these, photons that the tissue absorbs; they excite no further emission");
  table.document("lit_side", "of these, photons that leave the lit side");
  table.document("other_side", "of these, photons that leave the other side");
  table.document("escape", "(lit_side + other_side) / emitted");
  table.document("residual", "1 - (reabsorbed + lit_side + other_side) / emitted: error of the balance of photons");
  table.columns.back().only_data = true;
  return table;
}

FluorescentSpecimen specimen_of(const JobRun& run, const std::string& text) {
  Session& session = run.session();
  const std::filesystem::path& cache = run.context.options().cache;
  const OneWavelength light(kEmission_nm.min);  // instruments have no film; fluorescence has wavelengths of its own
  FluorescentSpecimen specimen{
      text, prepared_material(text, session.registry(), light, session.pool(), run.log(), cache), nullptr,
      // Adding a material does not change the random numbers of others.
      hash_key(run.args.seed("seed"), material_seed(text))};
  const auto* fluorescent = dynamic_cast<const FluorescentMaterial*>(specimen.material.get());
  if (!fluorescent)
    fail({}, "{} has no fluorescence; {} have, with a quantum yield: NAME,fluorescence=0.01", text,
         fluorescing_models(session.registry()));
  specimen.fluorescence = fluorescent->fluorescence({light, session.pool(), run.log(), cache});
  if (specimen.fluorescence->is_black())
    run.log().warn({}, fmt::format("{} emits nothing: fluorescence=0.01 gives {} a quantum yield, and "
                                   "fluorescencematrices=FILE gives any leaf matrices",
                                   text, fluorescing_models(session.registry())));
  return specimen;
}

}  // namespace

std::vector<double> ascending_wavelengths(const Arguments& args, std::string_view name) {
  std::vector<double> nm = args.numbers(name);
  if (nm.empty() || std::ranges::adjacent_find(nm, std::greater_equal()) != nm.end())
    fail({}, "{}: wavelengths in ascending order are needed, as in 400:750:10", args.spelled(name));
  return nm;
}

std::vector<FluorescentSpecimen> fluorescent_specimens(const JobRun& run) {
  std::vector<FluorescentSpecimen> specimens;
  for (const std::string& text : materials_of(run)) specimens.push_back(specimen_of(run, text));
  return specimens;
}

std::vector<std::string> fluorescence_notes(const JobRun& run, std::string_view instrument,
                                            const std::vector<FluorescentSpecimen>& specimens) {
  std::vector<std::string> notes{fmt::format("frond {} {}, fluorescence", FROND_VERSION, instrument)};
  for (const FluorescentSpecimen& s : specimens)
    notes.push_back(fmt::format("material: {}; emission: {}", s.label, s.fluorescence->emission_shape()));
  notes.push_back(fmt::format("seed: {}", run.args.seed("seed")));
  notes.push_back("Photons, not energy. Reabsorbed fluorescence does not excite again.");
  return notes;
}

std::string emission_text(const std::vector<FluorescentSpecimen>& specimens) {
  std::string text;
  for (const FluorescentSpecimen& s : specimens)
    text += fmt::format("{}; emission: {}\n", s.label, s.fluorescence->emission_shape());
  return text;
}

// Errors of the request and of every material are reported before the first ray.
Result fluorescence_result(const JobRun& run) {
  const std::vector<double> excitation_nm = ascending_wavelengths(run.args, "excitation"),
                            emission_nm = ascending_wavelengths(run.args, "emission"),
                            angles_deg = run.args.numbers("angles");
  // Of each pair of wavelengths: standard errors of about 2 % where the leaf absorbs.
  constexpr int64_t kRays = 10'000;
  const int64_t rays = run.args.given("rays") ? run.args.count("rays") : kRays;
  const size_t count = materials_of(run).size() * angles_deg.size();
  if (run.args.given("plot")) check_excitation_emission_chart(count, excitation_nm.size(), emission_nm.size());
  const std::vector<FluorescentSpecimen> specimens = fluorescent_specimens(run);

  std::vector<LabelledMatrix> matrices;
  for (const FluorescentSpecimen& s : specimens)
    for (const double theta_deg : angles_deg) {
      const auto progress = [&](double share) {
        run.check_stop();
        if (run.control.progress) run.control.progress->update((double(matrices.size()) + share) / double(count), {});
      };
      matrices.push_back(
          {s.label, measure_fluorescence(*s.fluorescence, {theta_deg, excitation_nm, emission_nm, rays, s.seed},
                                         run.session().pool(), progress)});
    }
  if (run.control.progress) run.control.progress->finish();
  if (run.args.given("plot")) write_chart(run.args.text("plot"), excitation_emission_chart(matrices));
  const Table balance = balance_table(matrices);
  return {.tables = {matrix_table(matrices), balance},
          .notes = fluorescence_notes(run, "spectrophotometer", specimens),
          .text = emission_text(specimens) + "photons per incident photon, over all emission\n" + to_text(balance)};
}

}  // namespace frond
