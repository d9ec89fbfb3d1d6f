#include "study/compare/report/tables.h"

#include <cmath>

#include "study/compare/error_unit.h"
#include "study/compare/report/html.h"
#include "study/compare/report/verdict.h"
#include "study/compare/speed_up.h"

namespace frond::compare {
namespace {

std::string ratio_text(double r) { return fmt::format("{:.2f}×", r); }

std::string ratio_text(const std::optional<Ratio>& r) {
  if (!r) return "–";
  if (r->kind == Ratio::Kind::not_reached) return "not reached";
  if (r->kind == Ratio::Kind::baseline_not_there) return "the baseline does not reach it";
  return ratio_text(r->value) + (r->kind == Ratio::Kind::extrapolated ? " (extrapolated)" : "");
}

std::string plateau_text(const CandidateResult& s) {
  const auto plateau = s.convergence(kAll).until_plateau();
  return plateau ? fmt::format("{} s, {:.0f} samples", figures(plateau->seconds, 3), plateau->samples) : "none found";
}

std::string cutoff_text(const CandidateResult& s) {
  const CutoffFit& end = s.paper->end;
  const std::string text = fmt::format("{:.2g} for {}", end.cutoff, s.candidate.label);
  return end.equal ? text : fmt::format("{} (which leaves {:.1e}: none leaves the same)", text, end.left.value);
}

/// Returns the note on the speed-up for equally complete paths; empty if the scene's integrator cannot render in the
/// paper's manner.
std::string paper_note(const Comparison& c) {
  std::vector<std::string> cutoffs;
  for (const CandidateResult& s : c.candidates)
    if (s.paper) cutoffs.push_back(cutoff_text(s));
  if (cutoffs.empty() || !c.candidates.front().paper) return "";
  const PaperTiming& baseline = *c.candidates.front().paper;
  return fmt::format(
      "Equally complete paths, as Baranoski and Rokne rendered: light sampling leaves out the surface lobe, and a path "
      "ends when the luminance of its throughput falls below a cutoff ({}), such that at a depth of {:.1f} hits all "
      "leave the same share of rays untraced, {:.1e} of those traced. ",
      fmt::join(cutoffs, ", "), baseline.depth, baseline.end.left.value);
}

std::string speed_table(const Comparison& c) {
  Table table{"Speed"};
  for (size_t i = 0; i < c.candidates.size(); ++i) {
    const CandidateResult& s = c.candidates[i];
    const SpeedUps v = speed_ups(c, i);
    const CandidateRun& r = s.runs.back();
    table.add("candidate", s.candidate.label);
    table.add("CPU s\nper sample", fmt::format("{:.3g}", r.cost.cpu_seconds / double(r.samples)));
    table.add("CPU s to\nprepare", fmt::format("{:.2g}", s.setup_cpu_seconds));
    table.add("noise below\nbias from", plateau_text(s));
    table.add("equal\nsamples", ratio_text(v.equal_samples));
    table.add("equally\ncomplete paths", v.paper ? ratio_text(*v.paper) : "–");
    table.add("equal error\n(--target)", ratio_text(v.equal_error));
    table.add("error of 1.5\n× its bias", ratio_text(v.equal_error_at_bias));
    table.add("equal\nnoise", ratio_text(v.equal_noise));
  }
  const std::string target = c.request.target
                                 ? fmt::format("an RMS error of {:g}, {:g} and {:g}", (*c.request.target)[0],
                                               (*c.request.target)[1], (*c.request.target)[2])
                             : c.request.relative ? "the RMS error of --target, which --relative excludes"
                                                  : "the RMS error of --target, which is not given";
  return to_html(
      table,
      fmt::format(
          "The last five columns are speed-ups: the CPU time of {} divided by the candidate’s. Equal samples: for "
          "an equal number of samples per pixel. {}Equal error: until red, green and blue have {}. Error of "
          "1.5 × its bias: until the RMS error of all channels is 1.5 times the candidate’s bias. Equal noise: "
          "until the variance is the same. Preparing a candidate takes little time if its table is in the cache.",
          c.candidates.front().candidate.label, paper_note(c), target));
}

constexpr const char* kTable2Note =
    "The quantities of Table 2 in the paper of Baranoski and Rokne, who give for their simplified model 0.009 0.009 "
    "0.012 "
    "and 5.14× (front lit), 0.011 0.014 0.010 and 4.47× (back lit), 0.020 0.016 0.012 and 9.77× (ambient light). RMS "
    "of "
    "images clipped to 1, linear SMPTE-C: theirs is between two noisy renders; here the reference’s noise is taken "
    "out. "
    "The table of speed-ups below defines the last four columns.";

/// Table 2 of the paper, for absolute errors of colours.
std::string table_2(const Comparison& c) {
  if (c.channels.are_bands() || c.request.relative) return "";
  Table table{fmt::format("RMS error of {} samples per pixel and speed-up, as in Table 2 of Baranoski and Rokne",
                          c.candidates.front().runs.back().samples)};
  for (size_t i = 0; i < c.candidates.size(); ++i) {
    const auto& e = c.candidates[i].runs.back().errors[kAll];
    const SpeedUps v = speed_ups(c, i);
    table.add("candidate", c.candidates[i].candidate.label);
    for (size_t k = kFirst; k < c.channels.luminance(); ++k)
      table.add("RMS\n" + c.channels.names[k], fmt::format("{:.4f}", e[k].clipped.root()));
    table.add("equal\nsamples", ratio_text(v.equal_samples));
    table.add("equally\ncomplete paths", v.paper ? ratio_text(*v.paper) : "–");
    table.add("equal error\n(--target)", ratio_text(v.equal_error));
    table.add("equal\nnoise", ratio_text(v.equal_noise));
  }
  return to_html(table, kTable2Note);
}

std::string offer_table(const Comparison& c, double rms, const char* note) {
  const ErrorUnit unit = c.request.error_unit();
  Table table{fmt::format("{} of {}", unit.is_relative() ? "A relative RMS" : "An RMS", unit.in_argument_unit(rms))};
  for (const CandidateCost& o : candidate_costs(c, rms, simultaneous_z(c))) {
    table.add("candidate", c.candidates[o.candidate].candidate.label);
    table.add("samples per pixel", o.effort  ? fmt::format("{:.0f}", std::ceil(o.effort->samples))
                                   : o.never ? "never"
                                             : "not known");
    table.add("CPU s", o.effort ? figures(o.effort->seconds, 3) + (o.effort->measured ? "" : " (extrapolated)") : "–");
  }
  return to_html(table, note);
}

constexpr const char* kOffersNote =
    "With bias and noise taken at the upper ends of intervals that hold all together with 95 % confidence. Not known: "
    "the error lies within the interval of the bias.";

constexpr int kDecimals = 4;

/// Returns the value and the upper end of its interval.
std::string value_with_bound(const ErrorUnit& unit, const MeanSquare& m) {
  return fmt::format("{} (≤ {})", unit.fixed(m.root(), kDecimals), unit.fixed(m.root_at(kZ95), kDecimals));
}

std::string worst_band(const Comparison& c, const std::vector<RenderError>& e) {
  const auto films = std::span(e).subspan(kFirst, c.channels.film_channels());
  const auto worst = std::ranges::max_element(films, {}, [](const RenderError& r) { return r.bias.value; });
  return c.channels.names[kFirst + size_t(worst - films.begin())] + ": " +
         value_with_bound(c.request.error_unit(), worst->bias);
}

std::string error_note(const Comparison& c) {
  if (c.request.relative)
    return fmt::format(
        "{} The reference’s noise is taken out. Bias is the error that remains with any number of samples.",
        kRelativeExplained);
  if (c.channels.are_bands())
    return "Radiance over that of a white diffuse surface of luminance 1 in the light of the scene. The reference’s "
           "noise "
           "is taken out. Bias is the error that remains with any number of samples.";
  return "Linear SMPTE-C. The reference’s noise is taken out. Bias is the error that remains with any number of "
         "samples. "
         "Clipped: of images clipped to 1, as in the paper of Baranoski and Rokne, whose two renders were both noisy.";
}

std::string error_table(const Comparison& c, Region region) {
  const ErrorUnit unit = c.request.error_unit();
  Table table{fmt::format("Error of one render of {} samples per pixel, {} pixels",
                          c.candidates.front().runs.back().samples, region == kAll ? "all" : "leaf")};
  for (const CandidateResult& s : c.candidates) {
    const auto& e = s.runs.back().errors[region];
    const auto fixed = [&](const MeanSquare& m, double z = 0) { return unit.fixed(m.root_at(z), kDecimals); };
    const auto triple = [&](MeanSquare RenderError::*value, double z = 0) {  // red, green and blue
      return fmt::format("{} {} {}", fixed(e[kFirst].*value, z), fixed(e[kFirst + 1].*value, z),
                         fixed(e[kFirst + 2].*value, z));
    };
    table.add("candidate", s.candidate.label);
    if (c.channels.are_bands()) {
      table.add("RMS\nall bands", fixed(e[kTogether].total));
      table.add("noise\nall bands", fixed(e[kTogether].noise));
      table.add("bias\nall bands", value_with_bound(unit, e[kTogether].bias));
      table.add("largest bias\nof a band", worst_band(c, e));
      continue;
    }
    // Clipped errors are compared with the paper's, which are absolute.
    if (!c.request.relative) table.add("RMS, clipped\nR G B", triple(&RenderError::clipped));
    table.add("RMS\nR G B", triple(&RenderError::total));
    table.add("noise\nR G B", triple(&RenderError::noise));
    table.add("bias\nR G B", triple(&RenderError::bias));
    table.add("bias ≤ (95 %)\nR G B", triple(&RenderError::bias, kZ95));
    table.add("bias\nluminance", value_with_bound(unit, e[c.channels.luminance()].bias));
    table.add("RMS\nluminance", fixed(e[c.channels.luminance()].total));
    if (region == kAll) table.add("FLIP", fmt::format("{:.4f}", s.runs.back().flip.value_or(0)));
  }
  return to_html(table, error_note(c));
}

/// Returns errors by band in a collapsed section, because there may be many bands.
std::string band_table(const Comparison& c) {
  if (!c.channels.are_bands()) return "";
  Table table{"Bias over all pixels",
              {{"band", std::vector(c.channels.names.begin() + kFirst, c.channels.names.end())}}};
  for (const CandidateResult& s : c.candidates) {
    std::vector<std::string> texts;
    for (const RenderError& e : std::span(s.runs.back().errors[kAll]).subspan(kFirst, c.channels.bands.size()))
      texts.push_back(value_with_bound(c.request.error_unit(), e.bias));
    table.columns.push_back({s.candidate.label, texts});
  }
  return "<details><summary>Bias band by band</summary>" +
         to_html(table, "In brackets the upper end of the 95 % interval.") + "</details>\n";
}

}  // namespace

std::string tables_html(const Comparison& c) {
  std::string html;
  for (const double rms : c.request.rms) html += offer_table(c, rms, rms == c.request.rms.back() ? kOffersNote : "");
  return html + table_2(c) + error_table(c, kAll) + error_table(c, kLeaf) + band_table(c) + speed_table(c);
}

}  // namespace frond::compare
