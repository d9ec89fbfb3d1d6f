#include "study/compare/error_tables.h"

#include <algorithm>
#include <span>

#include "study/compare/html.h"

namespace frond::compare {
namespace {

constexpr int kDecimals = 4;

/// The value, and the upper end of its interval.
std::string bounded(const ErrorUnit& unit, const MeanSquare& m) {
  return fmt::format("{} (≤ {})", unit.fixed(m.root(), kDecimals), unit.fixed(m.root_at(kZ95), kDecimals));
}

std::string worst_band(const Comparison& c, const std::vector<RenderError>& e) {
  const auto films = std::span(e).subspan(kFirst, c.channels.film_channels());
  const auto worst = std::ranges::max_element(films, {}, [](const RenderError& r) { return r.bias.value; });
  return c.channels.names[kFirst + size_t(worst - films.begin())] + ": " + bounded(c.request.error_unit(), worst->bias);
}

std::string error_note(const Comparison& c) {
  if (c.request.relative)
    return std::string(kRelativeExplained) +
           " The reference’s noise is taken out. Bias is what no number of samples takes away.";
  const std::string unit =
      c.channels.are_bands() ? "Radiance over that of a white diffuse surface of luminance 1 in the light of the scene."
                             : "Linear SMPTE-C.";
  return unit +
         " The paper’s RMS is that of clipped pictures, of two renders that are both noisy; here the reference’s "
         "noise is taken out. Bias is what no number of samples takes away.";
}

std::string error_table(const Comparison& c, Region region) {
  const ErrorUnit unit = c.request.error_unit();
  Table table{fmt::format("Error of one render of {} samples per pixel, {} pixels",
                          c.subjects.front().rungs.back().samples, region == kAll ? "all" : "leaf")};
  for (const Subject& s : c.subjects) {
    const auto& e = s.rungs.back().errors[region];
    const auto fixed = [&](const MeanSquare& m, double z = 0) { return unit.fixed(m.root_at(z), kDecimals); };
    const auto triple = [&](MeanSquare RenderError::*value, double z = 0) {  // red, green and blue
      return fmt::format("{} {} {}", fixed(e[kFirst].*value, z), fixed(e[kFirst + 1].*value, z),
                         fixed(e[kFirst + 2].*value, z));
    };
    table.add("candidate", s.candidate.label);
    if (c.channels.are_bands()) {
      table.add("RMS\nall bands", fixed(e[kTogether].total));
      table.add("noise\nall bands", fixed(e[kTogether].noise));
      table.add("bias\nall bands", bounded(unit, e[kTogether].bias));
      table.add("largest bias\nof a band", worst_band(c, e));
      continue;
    }
    // What is clipped is compared with the paper, whose errors are absolute.
    if (!c.request.relative) table.add("RMS, clipped\nR G B", triple(&RenderError::clipped));
    table.add("RMS\nR G B", triple(&RenderError::total));
    table.add("noise\nR G B", triple(&RenderError::noise));
    table.add("bias\nR G B", triple(&RenderError::bias));
    table.add("bias ≤ (95 %)\nR G B", triple(&RenderError::bias, kZ95));
    table.add("bias\nluminance", bounded(unit, e[c.channels.luminance()].bias));
    table.add("RMS\nluminance", fixed(e[c.channels.luminance()].total));
    if (region == kAll) table.add("FLIP", fmt::format("{:.4f}", s.rungs.back().flip.value_or(0)));
  }
  return to_html(table, error_note(c));
}

/// Band by band; folded away, as there may be many.
std::string band_table(const Comparison& c) {
  if (!c.channels.are_bands()) return "";
  Table table{"Bias over all pixels",
              {{"band", std::vector(c.channels.names.begin() + kFirst, c.channels.names.end())}}};
  for (const Subject& s : c.subjects) {
    std::vector<std::string> texts;
    for (const RenderError& e : std::span(s.rungs.back().errors[kAll]).subspan(kFirst, c.channels.bands.size()))
      texts.push_back(bounded(c.request.error_unit(), e.bias));
    table.columns.push_back({s.candidate.label, texts});
  }
  return "<details><summary>Bias band by band</summary>" +
         to_html(table, "In brackets the upper end of the 95 % interval.") + "</details>\n";
}

}  // namespace

std::string error_tables(const Comparison& c) { return error_table(c, kAll) + error_table(c, kLeaf) + band_table(c); }

}  // namespace frond::compare
