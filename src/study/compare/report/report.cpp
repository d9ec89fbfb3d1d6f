#include "study/compare/report/report.h"

#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "spectra/color/color_space.h"
#include "study/compare/report/assets.h"
#include "study/compare/report/charts.h"
#include "study/compare/report/html.h"
#include "study/compare/report/tables.h"
#include "study/compare/report/verdict.h"
#include "system/new_files.h"

namespace frond::compare {
namespace {

void write_charts(NewFiles& files, const std::vector<ReportChart>& charts) {
  const bool with_png = png_refusal().empty();
  for (const ReportChart& c : charts) {
    if (!c.chart) continue;
    files.write(c.name + ".svg", chart_svg(*c.chart));
    if (with_png) files.write(c.name + ".png", chart_png(*c.chart));
  }
}

std::string figure(const ReportChart& chart) {
  if (!chart.chart) return "<p>There is nothing to draw: no error was seen.</p>\n";
  const std::string svg = chart_svg(*chart.chart);
  return fmt::format(
      "<figure><img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\"><figcaption>{}</figcaption></figure>\n",
      html_text(chart.description), base64({reinterpret_cast<const unsigned char*>(svg.data()), svg.size()}),
      html_text(chart.caption));
}

std::string html_figures(const std::vector<ReportChart>& charts) {
  std::string html;
  for (const ReportChart& chart : charts) html += figure(chart);
  return html;
}

nlohmann::ordered_json image_json(const std::string& name, const Image& image) {
  return {{"name", name}, {"rgb", half_floats(image.pixels)}};
}

std::vector<double> srgb_from_smpte() {
  const Matrix3 m = color_space("srgb", {}).rgb_from_xyz * color_space(kErrorSpace, {}).xyz_from_rgb;
  std::vector<double> values;
  for (const Triple& row : m.row) values.insert(values.end(), row.begin(), row.end());
  return values;
}

std::string viewer_data(const Comparison& c) {
  nlohmann::ordered_json json{
      {"width", c.width}, {"height", c.height}, {"exposure", c.exposure_stops}, {"srgb_from_smpte", srgb_from_smpte()}};
  json["images"].push_back(
      image_json(fmt::format("reference: {}, {} samples", c.reference.candidate.label, 2 * c.reference.samples),
                 c.reference.image));
  for (const CandidateResult& s : c.candidates) {
    const uint64_t top = s.runs.back().samples;
    json["images"].push_back(image_json(fmt::format("{}, {} samples", s.candidate.label, 2 * top), s.late));
    json["images"].push_back(image_json(fmt::format("{}, {} samples", s.candidate.label, c.early_samples), s.early));
  }
  std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) text.replace(at, 2, "<\\/");
  return text;
}

std::string setting(const Comparison& c) {
  const ErrorUnit unit = c.request.error_unit();
  return html_text(fmt::format(
      "{}×{} pixels, leaves in {:.1f} % of the view, materials replaced: {}. Reference: {}, two renders of {} samples; "
      "its own noise, {} of {}, is taken out of all figures.{}",
      c.width, c.height, 100 * c.foliar_ratio, fmt::join(c.leaves, ", "), c.reference.candidate.text,
      c.reference.samples, unit.rms(), unit.rounded(c.reference.noise[kAll][kTogether].root()),
      unit.is_relative() ? fmt::format(" {}", kRelativeExplained) : ""));
}

std::string values_note(const ChannelList& channels) {
  if (channels.are_bands())
    return html_text(fmt::format("Images of {} bands: {}. Values are those of the images.", channels.bands.size(),
                                 channels.how_shown));
  return "Values are linear SMPTE-C; 1 is a white diffuse surface in the light.";
}

std::string provenance(const Comparison& c) {
  std::string list = "<dl>";
  const auto add = [&list](const std::string& term, const std::string& text, bool is_code) {
    const std::string safe = html_text(text);
    list += fmt::format("<dt>{}</dt><dd>{}</dd>", html_text(term), is_code ? "<code>" + safe + "</code>" : safe);
  };
  add("command", c.command, true);
  add("frond", FROND_VERSION, false);
  add("machine", c.machine, false);
  add("time", fmt::format("{:.0f} s, {:.0f} s of CPU", c.wall_seconds, c.cpu_seconds), false);
  add("reference",
      fmt::format("{}: {} of 2 × {} samples from the cache", c.reference.candidate.text, 2 * c.reference.cached_samples,
                  c.reference.samples),
      false);
  for (const CandidateResult& s : c.candidates) {
    add(s.candidate.label, fmt::format("{} with wavelengths {}", s.candidate.text, s.wavelengths), true);
    if (s.paper) add(s.candidate.label + ", equally complete paths", s.paper->candidate.text, true);
  }
  return list + "</dl>";
}

std::string page(const Comparison& c, const std::vector<ReportChart>& charts) {
  return filled(page_html, {{"title", html_text("Leaf models compared: " + c.scene)},
                            {"css", std::string(page_css)},
                            {"verdict", html_text(verdict(c))},
                            {"setting", setting(c)},
                            {"values", values_note(c.channels)},
                            {"charts", html_figures(charts)},
                            {"tables", tables_html(c)},
                            {"provenance", provenance(c)},
                            {"data", viewer_data(c)},
                            {"js", std::string(viewer_js)}});
}

}  // namespace

std::vector<std::string> report_files() {
  std::vector<std::string> names{"compare.csv", "compare.json", "index.html"};
  for (const std::string chart : {"rms", "rms-leaf", "bands", "flip"})
    for (const char* extension : {".svg", ".png"}) names.push_back(chart + extension);
  return names;
}

void check_report_folder(const std::filesystem::path& folder) {
  const NewFiles files(folder);
  for (const std::string& name : report_files()) files.check(name);
}

void write_report(const std::filesystem::path& folder, const Comparison& c, const ComparisonData& data) {
  NewFiles files(folder);
  const std::vector<ReportChart> charts = charts_of(c);
  write_charts(files, charts);
  files.write("compare.csv", to_csv(data.tables[0], data.notes));
  files.write("compare.json", to_json(data.notes, data.facts, data.tables));
  files.write("index.html", page(c, charts));
  files.finish();
}

}  // namespace frond::compare
