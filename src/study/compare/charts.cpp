#include "study/compare/charts.h"

#include "study/compare/bands_chart.h"
#include "study/compare/curves_chart.h"

namespace frond::compare {
namespace {

/// Below the axes the key takes a line for each candidate.
constexpr int kWidth = 900, kAxesHeight = 560, kKeyLine = 20;

int height_of(const Comparison& c, size_t more_lines) {
  return kAxesHeight + kKeyLine * int(c.subjects.size() + more_lines);
}

std::string rms_caption(const Comparison& c) {
  return fmt::format(
      "One point for each doubling of samples per pixel, from {} to {}; bars are 95 % intervals. Error is against what "
      "the reference converges to: its noise, {}, is taken out. A cross and the dotted line after it: from there "
      "on noise is below the candidate’s bias, and more samples help little. A curve without one has no bias that "
      "could be told from none.",
      c.subjects.front().rungs.front().samples, c.subjects.front().rungs.back().samples,
      c.request.error_unit().rounded(c.reference.noise[kAll][kTogether].root()));
}

std::string flip_caption(const Comparison& c) {
  return fmt::format(
      "What a person would see who flips between a render and the reference (Andersson et al. 2020, 67 pixels per "
      "degree, exposure {:+g} stops); 0: nothing, 1: all. The reference’s two renders differ by {:.2g}.",
      c.exposure_stops, c.reference.flip.value_or(0));
}

constexpr const char* kBandsCaption =
    "All pixels. Points: bias, with bars of 95 %. A bar without a point: a bias that cannot be told from none, up to "
    "the bar’s end. Dotted: the noise that is left.";

Chart curves(const Comparison& c, Measure measure, const char* name, const char* description, std::string caption) {
  return {name,   description,    std::move(caption), has_curves(c, measure) ? curves_chart(c, measure) : "",
          kWidth, height_of(c, 1)};
}

}  // namespace

std::vector<Chart> charts_of(const Comparison& c) {
  std::vector<Chart> charts{
      curves(c, Measure::rms_all, "rms", "RMS error against CPU time, all pixels", rms_caption(c)),
      curves(c, Measure::rms_leaf, "rms-leaf", "RMS error against CPU time, leaf pixels",
             "The same over the pixels that see a leaf.")};
  if (c.channels.are_bands())
    charts.push_back(
        {"bands", "Bias and noise against wavelength", kBandsCaption, bands_chart(c), kWidth, height_of(c, 2)});
  else
    charts.push_back(curves(c, Measure::flip, "flip", "FLIP against CPU time", flip_caption(c)));
  return charts;
}

}  // namespace frond::compare
