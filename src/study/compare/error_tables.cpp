#include "study/compare/error_tables.h"

#include <algorithm>

#include "study/compare/html.h"
#include "study/compare/html_table.h"

namespace frond::compare {
namespace {

constexpr int kDecimals = 4;

/// The value, and the upper end of its interval.
std::string bounded(const ErrorUnit& unit, const MeanSquare& m) {
  return fmt::format("{} (≤ {})", unit.fixed(m.root(), kDecimals), unit.fixed(m.root_at(kZ95), kDecimals));
}

/// A row of the table of errors: what is told of one candidate in one region.
using Errors = std::vector<RenderError>;
struct ErrorColumn {
  const char* title;
  std::string (*text)(const Comparison&, const Errors&);
};

/// Red, green and blue.
template <MeanSquare RenderError::*value>
std::string triple_at(const Comparison& c, const Errors& e, double z) {
  const ErrorUnit unit = c.request.error_unit();
  const auto text = [&](size_t channel) { return unit.fixed((e[kFirst + channel].*value).root_at(z), kDecimals); };
  return fmt::format("{} {} {}", text(0), text(1), text(2));
}
template <MeanSquare RenderError::*value>
std::string triple(const Comparison& c, const Errors& e) {
  return triple_at<value>(c, e, 0);
}
std::string bias_bounds(const Comparison& c, const Errors& e) { return triple_at<&RenderError::bias>(c, e, kZ95); }
template <MeanSquare RenderError::*value>
std::string together(const Comparison& c, const Errors& e) {
  return c.request.error_unit().fixed((e[kTogether].*value).root(), kDecimals);
}
std::string bias_together(const Comparison& c, const Errors& e) {
  return bounded(c.request.error_unit(), e[kTogether].bias);
}
std::string luminance_bias(const Comparison& c, const Errors& e) {
  return bounded(c.request.error_unit(), e[c.channels.luminance()].bias);
}
std::string luminance_rms(const Comparison& c, const Errors& e) {
  return c.request.error_unit().fixed(e[c.channels.luminance()].total.root(), kDecimals);
}
std::string worst_band(const Comparison& c, const Errors& e) {
  const auto films = std::span(e).subspan(kFirst, c.channels.film_channels());
  const auto worst = std::ranges::max_element(films, {}, [](const RenderError& r) { return r.bias.value; });
  return c.channels.names[kFirst + size_t(worst - films.begin())] + ": " + bounded(c.request.error_unit(), worst->bias);
}

constexpr std::array<ErrorColumn, 7> kColorColumns{{{"RMS, clipped<br>R G B", triple<&RenderError::clipped>},
                                                    {"RMS<br>R G B", triple<&RenderError::total>},
                                                    {"noise<br>R G B", triple<&RenderError::noise>},
                                                    {"bias<br>R G B", triple<&RenderError::bias>},
                                                    {"bias ≤ (95 %)<br>R G B", bias_bounds},
                                                    {"bias<br>luminance", luminance_bias},
                                                    {"RMS<br>luminance", luminance_rms}}};
constexpr std::array<ErrorColumn, 4> kBandColumns{{{"RMS<br>all bands", together<&RenderError::total>},
                                                   {"noise<br>all bands", together<&RenderError::noise>},
                                                   {"bias<br>all bands", bias_together},
                                                   {"largest bias<br>of a band", worst_band}}};

/// What is clipped is compared with the paper, whose errors are absolute.
std::span<const ErrorColumn> columns_of(const Comparison& c) {
  if (c.channels.are_bands()) return kBandColumns;
  return std::span(kColorColumns).subspan(c.request.relative ? 1 : 0);
}

std::string error_row(const Comparison& c, const Subject& s, Region region) {
  const Rung& r = s.rungs.back();
  std::string row = "<tr>" + cell(html_text(s.candidate.label));
  for (const ErrorColumn& column : columns_of(c)) row += cell(column.text(c, r.errors[region]));
  return row + (region == kAll && r.flip ? cell(fmt::format("{:.4f}", *r.flip)) : "") + "</tr>\n";
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
  std::string rows;
  for (const Subject& s : c.subjects) rows += error_row(c, s, region);
  std::vector<std::string> titles{"candidate"};
  for (const ErrorColumn& column : columns_of(c)) titles.emplace_back(column.title);
  if (region == kAll && !c.channels.are_bands()) titles.emplace_back("FLIP");
  return table(fmt::format("Error of one render of {} samples per pixel, {} pixels",
                           c.subjects.front().rungs.back().samples, region == kAll ? "all" : "leaf"),
               head(titles), rows, error_note(c));
}

/// Band by band; folded away, as there may be many.
std::string band_table(const Comparison& c) {
  if (!c.channels.are_bands()) return "";
  std::vector<std::string> titles{"band"};
  for (const Subject& s : c.subjects) titles.push_back(html_text(s.candidate.label));
  std::string rows;
  for (size_t b = 0; b < c.channels.bands.size(); ++b) {
    rows += "<tr>" + cell(c.channels.names[kFirst + b]);
    for (const Subject& s : c.subjects)
      rows += cell(bounded(c.request.error_unit(), s.rungs.back().errors[kAll][kFirst + b].bias));
    rows += "</tr>\n";
  }
  return "<details><summary>Bias band by band</summary>" +
         table("Bias over all pixels", head(titles), rows, "In brackets the upper end of the 95 % interval.") +
         "</details>\n";
}

}  // namespace

std::string error_tables(const Comparison& c) { return error_table(c, kAll) + error_table(c, kLeaf) + band_table(c); }

}  // namespace frond::compare
