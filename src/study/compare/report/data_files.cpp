#include "study/compare/report/data_files.h"

#include <fmt/ranges.h>

#include <cmath>

#include "study/compare/report/verdict.h"
#include "study/compare/speed_up.h"

namespace frond::compare {
namespace {

void add_interval(Table& table, const std::string& name, const MeanSquare& m) {
  table.add(name, m.root());
  table.add(name + "_low", m.root_at(-kZ95));
  table.add(name + "_high", m.root_at(kZ95));
}

void add_effort(Table& table, const std::string& name, const std::optional<Effort>& e) {
  table.add(name + "samples", e ? e->samples : NAN);
  table.add(name + "cpu_seconds", e ? e->seconds : NAN);
  table.add_flag(name + "measured", e && e->measured);
}

void add_ratio(Table& table, const std::string& name, const std::optional<Ratio>& r) {
  constexpr std::array kKinds{"measured", "extrapolated", "not reached", "baseline not there"};
  table.add(name, r && r->value > 0 ? r->value : NAN);
  table.add(name + "_kind", r ? kKinds[size_t(r->kind)] : "");
}

Table comparison_table(const Comparison& c) {
  Table table{"comparison"};
  for (const CandidateResult& s : c.candidates)
    for (const CandidateRun& r : s.runs)
      for (size_t region = 0; region < kRegions; ++region)
        for (size_t k = 0; k < c.channels.names.size(); ++k) {
          const RenderError& e = r.errors[region][k];
          table.add("candidate", s.candidate.label);
          table.add("samples", double(r.samples));
          table.add("cpu_seconds", r.cost.cpu_seconds);
          table.add("wall_seconds", r.cost.wall_seconds);
          table.add("flip", r.flip.value_or(NAN));
          table.add("region", kRegionNames[region]);
          table.add("channel", c.channels.names[k]);
          add_interval(table, "rms", e.total);
          add_interval(table, "rms_clipped", e.clipped);
          add_interval(table, "noise", e.noise);
          add_interval(table, "bias", e.bias);
          table.add("setup_cpu_seconds", s.setup_cpu_seconds);
          table.add("rays", double(r.cost.rays));
        }
  return table;
}

Table candidate_table(const Comparison& c) {
  Table table{"candidates"};
  for (size_t i = 0; i < c.candidates.size(); ++i) {
    const CandidateResult& s = c.candidates[i];
    table.add("label", s.candidate.label);
    table.add("candidate", s.candidate.text);
    table.add("wavelengths", s.wavelengths);
    table.add("setup_cpu_seconds", s.setup_cpu_seconds);
    for (size_t region = 0; region < kRegions; ++region)
      add_effort(table, fmt::format("plateau_{}_", kRegionNames[region]),
                 s.convergence(Region(region)).until_plateau());
    const SpeedUps v = speed_ups(c, i);
    table.add("a_equal_samples", v.equal_samples);
    table.add("b_paper", v.paper.value_or(NAN));
    add_ratio(table, "c_equal_error", v.equal_error);
    add_ratio(table, "c_equal_error_at_1.5_bias", v.equal_error_at_bias);
    table.add("d_equal_noise", v.equal_noise);
    const PaperTiming paper = s.paper.value_or(PaperTiming{{}, NAN, {NAN, {NAN, NAN}, false}, NAN});
    table.add("paper_candidate", paper.candidate.text);
    table.add("paper_cpu_seconds_per_sample", paper.cpu_seconds_per_sample);
    table.add("paper_tree_depth", paper.depth);
    table.add("paper_cutoff", paper.end.cutoff);
    table.add("paper_unshot_per_shot", paper.end.left.value);
    table.add("paper_unshot_relative_error", paper.end.left.relative_error);
    table.add_flag("paper_ratio_is_the_baselines", paper.end.equal);
  }
  return table;
}

Table effort_table(const Comparison& c) {
  Table table{"meets_rms"};
  for (const double rms : c.request.rms)
    for (const CandidateResult& s : c.candidates) {
      table.add("rms", rms);
      table.add("candidate", s.candidate.label);
      add_effort(table, "", s.convergence(kAll).until_rms(rms, simultaneous_z(c)));
    }
  return table;
}

Table reference_table(const Comparison& c) {
  Table table{"reference"};
  for (size_t region = 0; region < kRegions; ++region)
    for (size_t k = 0; k < c.channels.names.size(); ++k) {
      const std::vector<double>& means = c.reference.mean[region];  // by channel, from kFirst on
      table.add("region", kRegionNames[region]);
      table.add("channel", c.channels.names[k]);
      add_interval(table, "noise", c.reference.noise[region][k]);
      table.add("mean", k >= kFirst && k - kFirst < means.size() ? means[k - kFirst] : NAN);
    }
  return table;
}

std::vector<Fact> facts_of(const Comparison& c) {
  const Reference& r = c.reference;
  std::vector<Fact> facts{{"machine", c.machine},
                          {"scene", c.scene},
                          {"width", double(c.width)},
                          {"height", double(c.height)},
                          {"foliar_ratio", c.foliar_ratio},
                          {"unit", c.request.error_unit().data_unit(c.channels)},
                          {"leaf_materials", fmt::format("{}", fmt::join(c.leaves, ", "))},
                          {"wall_seconds", c.wall_seconds},
                          {"cpu_seconds", c.cpu_seconds},
                          {"exposure_stops", c.exposure_stops},
                          {"verdict", verdict(c)},
                          {"reference_candidate", r.candidate.text},
                          {"reference_samples", double(r.samples)},
                          {"reference_samples_from_cache", double(r.cached_samples)},
                          {"reference_cpu_seconds", 2 * r.cost.cpu_seconds},
                          {"reference_flip", r.flip.value_or(NAN)},
                          {"reference_mean_unit", c.channels.unit}};
  if (c.request.target)
    facts.push_back({"rms_target", std::vector(c.request.target->begin(), c.request.target->end())});
  std::vector<double> nm;
  for (const Band& band : c.channels.bands) nm.push_back(band.nm);
  if (!nm.empty()) facts.push_back({"band_nm", nm});
  return facts;
}

}  // namespace

ComparisonData data_of(const Comparison& c) {
  return {
      {comparison_table(c), candidate_table(c), effort_table(c), reference_table(c)},
      facts_of(c),
      {c.command, std::string("frond ") + FROND_VERSION,
       "One render of so many samples per pixel: its time, and how far it is from what the reference converges to.",
       fmt::format("Unit: {}; {}: root of the mean square of all the film's channels; leaf: pixels that see a leaf.",
                   c.request.error_unit().data_unit(c.channels), c.channels.names[kTogether]),
       fmt::format("rms = bias and noise; rms_clipped: of images clipped to [0, 1]; _low, _high: 95 % intervals; "
                   "flip: mean FLIP{}.",
                   c.channels.are_bands() ? ", none of bands" : "")}};
}

}  // namespace frond::compare
