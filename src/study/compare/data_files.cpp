#include "study/compare/data_files.h"

#include <nlohmann/json.hpp>

#include "report/text_output.h"
#include "study/compare/speed_up.h"
#include "study/compare/verdict.h"

namespace frond::compare {
namespace {

using Json = nlohmann::ordered_json;

std::string notes(const ChannelList& channels, const ErrorUnit& unit) {
  return fmt::format(
      "# One render of so many samples per pixel: its time, and how far it is from what the reference converges to.\n"
      "# Unit: {}; {}: root of the mean square of all the film's channels; leaf: pixels that see a leaf.\n"
      "# rms = bias and noise; rms_clipped: of pictures clipped to [0, 1]; _low, _high: 95 % intervals; flip: mean "
      "FLIP{}.\n",
      unit.of_data(channels), channels.names[kTogether], channels.are_bands() ? ", none of bands" : "");
}

struct Column {
  const char* name;
  MeanSquare RenderError::*value;
};
constexpr std::array<Column, 4> kColumns{{{"rms", &RenderError::total},
                                          {"rms_clipped", &RenderError::clipped},
                                          {"noise", &RenderError::noise},
                                          {"bias", &RenderError::bias}}};

/// What is known by region and channel, one by one.
template <class Table, class Each>
void for_each_entry(const ChannelList& channels, const Table& table, const Each& each) {
  for (size_t region = 0; region < kRegions; ++region)
    for (size_t c = 0; c < channels.names.size(); ++c) each(kRegionNames[region], channels.names[c], table[region][c]);
}

Json interval(const MeanSquare& m) {
  return {{"value", m.root()}, {"low", m.root_at(-kZ95)}, {"high", m.root_at(kZ95)}};
}

Json rung_json(const ChannelList& channels, const Rung& rung) {
  Json json{{"samples", rung.samples},
            {"cpu_seconds", rung.cost.cpu_seconds},
            {"wall_seconds", rung.cost.wall_seconds},
            {"rays", rung.cost.rays}};
  if (rung.flip) json["flip"] = *rung.flip;
  for_each_entry(channels, rung.errors, [&json](const char* region, const std::string& channel, const RenderError& e) {
    for (const Column& column : kColumns) json[region][channel][column.name] = interval(e.*column.value);
  });
  return json;
}

Json ratio_json(const std::optional<Ratio>& r) {
  if (!r) return nullptr;
  constexpr std::array kKinds{"measured", "extrapolated", "not reached", "baseline not there"};
  Json json{{"kind", kKinds[size_t(r->kind)]}};
  if (r->value > 0) json["value"] = r->value;
  return json;
}

Json speed_up_json(const SpeedUps& s) {
  return {{"a_equal_samples", s.equal_samples},
          {"b_paper", s.paper ? Json(*s.paper) : Json()},
          {"c_equal_error", ratio_json(s.equal_error)},
          {"c_equal_error_at_1.5_bias", ratio_json(s.equal_error_at_bias)},
          {"d_equal_noise", s.equal_noise}};
}

Json paper_json(const PaperTiming& p) {
  return {{"candidate", p.candidate.text},
          {"cpu_seconds_per_sample", p.cpu_seconds_per_sample},
          {"tree_depth", p.depth},
          {"cutoff", p.end.cutoff},
          {"unshot_per_shot", p.end.left.value},
          {"unshot_relative_error", p.end.left.relative_error},
          {"ratio_is_the_baselines", p.end.equal}};
}

Json effort_json(const std::optional<Effort>& e) {
  if (!e) return nullptr;
  return {{"samples", e->samples}, {"cpu_seconds", e->seconds}, {"measured", e->measured}};
}

Json subject_json(const Comparison& c, size_t i) {
  const Subject& s = c.subjects[i];
  Json json{{"label", s.candidate.label},
            {"candidate", s.candidate.text},
            {"wavelengths", s.wavelengths},
            {"setup_cpu_seconds", s.setup_cpu_seconds}};
  for (size_t region = 0; region < kRegions; ++region)
    json["plateau"][kRegionNames[region]] = effort_json(s.convergence(Region(region)).until_plateau());
  json["speed_up"] = speed_up_json(speed_ups(c, i));
  if (s.paper) json["paper_manner"] = paper_json(*s.paper);
  for (const double rms : c.request.rms)
    json["meets_rms"].push_back(
        {{"rms", rms}, {"effort", effort_json(s.convergence(kAll).until_rms(rms, simultaneous_z(c)))}});
  for (const Rung& rung : s.rungs) json["rungs"].push_back(rung_json(c.channels, rung));
  return json;
}

Json reference_json(const ChannelList& channels, const Reference& r) {
  Json json{{"candidate", r.candidate.text},
            {"renders", 2},
            {"samples", r.samples},
            {"samples_from_cache", r.cached_samples},
            {"cpu_seconds", 2 * r.cost.cpu_seconds}};
  if (r.flip) json["flip_between_its_two_renders"] = *r.flip;
  for_each_entry(channels, r.noise, [&json](const char* region, const std::string& channel, const MeanSquare& noise) {
    json["noise"][region][channel] = interval(noise);
  });
  for (size_t region = 0; region < kRegions; ++region)
    for (size_t i = 0; i < r.mean[region].size(); ++i)
      json["mean"][kRegionNames[region]][channels.names[kFirst + i]] = r.mean[region][i];
  if (json.contains("mean")) json["mean_unit"] = channels.unit;
  return json;
}

}  // namespace

std::string comparison_csv(const Comparison& c) {
  std::string csv = fmt::format("# {}\n# frond {}\n", c.command, FROND_VERSION);
  csv += notes(c.channels, c.request.error_unit());
  csv += "candidate,samples,cpu_seconds,wall_seconds,flip,region,channel";
  for (const Column& column : kColumns) csv += fmt::format(",{0},{0}_low,{0}_high", column.name);
  csv += '\n';
  for (const Subject& s : c.subjects)
    for (const Rung& r : s.rungs)
      for_each_entry(c.channels, r.errors, [&](const char* region, const std::string& channel, const RenderError& e) {
        csv += fmt::format("{},{},{:.6g},{:.6g},{},{},{}", csv_field(s.candidate.label), r.samples, r.cost.cpu_seconds,
                           r.cost.wall_seconds, r.flip ? fmt::format("{:.6g}", *r.flip) : "", region, channel);
        for (const Column& column : kColumns) {
          const MeanSquare& m = e.*column.value;
          csv += fmt::format(",{:.6g},{:.6g},{:.6g}", m.root(), m.root_at(-kZ95), m.root_at(kZ95));
        }
        csv += '\n';
      });
  return csv;
}

std::string comparison_json(const Comparison& c) {
  Json json{{"command", c.command},
            {"version", FROND_VERSION},
            {"machine", c.machine},
            {"scene", c.scene},
            {"width", c.width},
            {"height", c.height},
            {"foliar_ratio", c.foliar_ratio},
            {"unit", c.request.error_unit().of_data(c.channels)},
            {"channels", c.channels.names},
            {"leaf_materials", c.leaves},
            {"wall_seconds", c.wall_seconds},
            {"cpu_seconds", c.cpu_seconds},
            {"exposure_stops", c.exposure_stops},
            {"verdict", verdict(c)},
            {"reference", reference_json(c.channels, c.reference)}};
  for (const Band& band : c.channels.bands) json["band_nm"].push_back(band.nm);
  if (!c.request.rms.empty()) json["rms_requested"] = c.request.rms;
  if (c.request.target) json["rms_target"] = *c.request.target;
  for (size_t i = 0; i < c.subjects.size(); ++i) json["candidates"].push_back(subject_json(c, i));
  return json.dump(1) + '\n';
}

}  // namespace frond::compare
