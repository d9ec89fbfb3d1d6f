#include "cli/compare/report.h"

#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "cli/compare/assets.h"
#include "cli/compare/curves_chart.h"
#include "cli/compare/data_files.h"
#include "cli/compare/html.h"
#include "cli/compare/tables.h"
#include "cli/compare/verdict.h"
#include "cli/gnuplot.h"
#include "cli/text_output.h"
#include "scene/file_bytes.h"
#include "spectra/color_space.h"

namespace frond::compare {
namespace {

struct Chart {
  const char* name;
  Measure measure;
};
constexpr std::array<Chart, 3> kCharts{
    {{"rms", Measure::rms_all}, {"rms-leaf", Measure::rms_leaf}, {"flip", Measure::flip}}};

/// Below the axes the key takes a line for each candidate.
constexpr int kChartWidth = 900, kAxesHeight = 560, kKeyLine = 20;

std::string path_in(const std::filesystem::path& folder, const std::string& name) { return (folder / name).string(); }

void write_charts(const std::filesystem::path& folder, const Comparison& c) {
  const int height = kAxesHeight + kKeyLine * int(c.subjects.size() + 1);
  for (const Chart& chart : kCharts) {
    if (!has_curves(c, chart.measure)) continue;
    const std::string script = curves_chart(c, chart.measure);
    for (const char* extension : {".svg", ".png"})
      write_chart(path_in(folder, chart.name + std::string(extension)), kChartWidth, height, script);
  }
}

std::string embedded_chart(const std::filesystem::path& folder, const Comparison& c, const Chart& chart,
                           const char* description) {
  if (!has_curves(c, chart.measure)) return "<p>There is nothing to draw: no error was seen.</p>";
  const std::string svg = read_file_bytes(path_in(folder, chart.name + std::string(".svg")), {});
  return fmt::format("<img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\">", html_text(description),
                     base64({reinterpret_cast<const unsigned char*>(svg.data()), svg.size()}));
}

nlohmann::ordered_json picture_json(const std::string& name, const Picture& picture) {
  return {{"name", name}, {"rgb", half_floats(interleaved(picture))}};
}

std::vector<double> srgb_from_smpte() {
  const Matrix3 m = color_space("srgb", {}).rgb_from_xyz * color_space(kErrorSpace, {}).xyz_from_rgb;
  std::vector<double> values;
  for (const Triple& row : m.row) values.insert(values.end(), row.begin(), row.end());
  return values;
}

std::string viewer_data(const Comparison& c) {
  nlohmann::ordered_json json{{"width", c.width},
                              {"height", c.height},
                              {"exposure", c.request.exposure_stops},
                              {"srgb_from_smpte", srgb_from_smpte()}};
  json["pictures"].push_back(
      picture_json(fmt::format("reference: {}, {} samples", c.reference.candidate.label, 2 * c.reference.samples),
                   c.reference.picture));
  for (const Subject& s : c.subjects) {
    const uint64_t top = s.rungs.back().samples;
    json["pictures"].push_back(picture_json(fmt::format("{}, {} samples", s.candidate.label, 2 * top), s.late));
    json["pictures"].push_back(
        picture_json(fmt::format("{}, {} samples", s.candidate.label, c.early_samples), s.early));
  }
  std::string text = json.dump();
  for (size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) text.replace(at, 2, "<\\/");
  return text;
}

std::string setting(const Comparison& c) {
  return html_text(fmt::format(
      "{}×{} pixels, leaves in {:.1f} % of the view, {}. Reference: {}, two renders of {} samples; its own noise, an "
      "RMS "
      "of {:.2g}, is taken out of all figures.",
      c.width, c.height, 100 * c.foliar_ratio, fmt::format("materials replaced: {}", fmt::join(c.leaves, ", ")),
      c.reference.candidate.text, c.reference.samples, c.reference.noise[kAll][kRgb].root()));
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
  for (const Subject& s : c.subjects) {
    add(s.candidate.label, fmt::format("{} with wavelengths {}", s.candidate.text, s.wavelengths), true);
    if (s.paper) add(s.candidate.label + " (b)", s.paper->candidate.text, true);
  }
  return list + "</dl>";
}

std::string caption_rms(const Comparison& c) {
  return html_text(fmt::format(
      "One point for each doubling of samples per pixel, from 1 to {}; bars are 95 % intervals. Error is against what "
      "the "
      "reference converges to: its noise, {:.2g}, is taken out. A cross and the dotted line after it: from there on "
      "noise is below the candidate’s bias, and more samples help little. A curve without one has no bias that could "
      "be "
      "told from none.",
      c.subjects.front().rungs.back().samples, c.reference.noise[kAll][kRgb].root()));
}

std::string caption_flip(const Comparison& c) {
  return html_text(fmt::format(
      "What a person would see who flips between a render and the reference (Andersson et al. 2020, 67 pixels per "
      "degree, exposure {:+g} stops); 0: nothing, 1: all. The reference’s two renders differ by {:.2g}.",
      c.request.exposure_stops, c.reference.flip));
}

std::string page(const std::filesystem::path& folder, const Comparison& c) {
  return filled(page_html,
                {{"title", html_text("Leaf models compared: " + c.scene)},
                 {"css", std::string(page_css)},
                 {"verdict", html_text(verdict(c))},
                 {"setting", setting(c)},
                 {"chart_rms_all", embedded_chart(folder, c, kCharts[0], "RMS error against CPU time, all pixels")},
                 {"chart_rms_leaf", embedded_chart(folder, c, kCharts[1], "RMS error against CPU time, leaf pixels")},
                 {"chart_flip", embedded_chart(folder, c, kCharts[2], "FLIP against CPU time")},
                 {"caption_rms", caption_rms(c)},
                 {"caption_flip", caption_flip(c)},
                 {"tables", tables_html(c)},
                 {"provenance", provenance(c)},
                 {"data", viewer_data(c)},
                 {"js", std::string(viewer_js)}});
}

}  // namespace

void check_report_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail({}, "cannot make the folder {}: {}", folder.string(), error.message());
  check_chart(path_in(folder, "rms.svg"));
}

void write_report(const std::filesystem::path& folder, const Comparison& c) {
  write_charts(folder, c);
  write_text(path_in(folder, "compare.csv"), comparison_csv(c));
  write_text(path_in(folder, "compare.json"), comparison_json(c));
  write_text(path_in(folder, "index.html"), page(folder, c));
}

}  // namespace frond::compare
