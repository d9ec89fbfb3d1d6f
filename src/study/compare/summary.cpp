#include "study/compare/summary.h"

#include <algorithm>

#include "study/compare/speed_up.h"

namespace frond::compare {

std::string summary_text(const Comparison& c) {
  size_t width = 10;
  for (const Subject& s : c.subjects) width = std::max(width, s.candidate.label.size());
  const ErrorUnit unit = c.request.error_unit();
  const auto fixed = [&unit](double error) { return unit.fixed(error, 5); };
  std::string text =
      fmt::format("{:<{}}  CPU s/sample  bias (95 %)                   noise of {:<5}  FLIP    (a)    (c*)   (d)\n",
                  "candidate", width, c.subjects.front().rungs.back().samples);
  for (size_t i = 0; i < c.subjects.size(); ++i) {
    const Subject& s = c.subjects[i];
    const Rung& r = s.rungs.back();
    const RenderError& e = r.errors[kAll][kTogether];
    const SpeedUps v = speed_ups(c, i);
    const bool told = v.equal_error_at_bias && v.equal_error_at_bias->value > 0;
    const std::string bias =
        fmt::format("{} ({} to {})", fixed(e.bias.root()), fixed(e.bias.root_at(-kZ95)), fixed(e.bias.root_at(kZ95)));
    text += fmt::format("{:<{}}  {:<12.3g}  {:<28}  {:<14}  {:<6}  {:<5.2f}  {:<5}  {:.2f}\n", s.candidate.label, width,
                        r.cost.cpu_seconds / double(r.samples), bias, fixed(e.noise.root()),
                        r.flip ? fmt::format("{:.4f}", *r.flip) : "-", v.equal_samples,
                        told ? fmt::format("{:.2f}", v.equal_error_at_bias->value) : "-", v.equal_noise);
  }
  if (unit.is_relative()) text += fmt::format("{}\n", kRelativeExplained);
  return text +
         "Speed-up by CPU time: (a) at equal samples, (c*) at an RMS of 1.5 times the bias, (d) at equal noise.\n";
}

}  // namespace frond::compare
