#include "report/table.h"
#include "study/compare/report/tables.h"
#include "study/compare/speed_up.h"

namespace frond::compare {

std::string summary_text(const Comparison& c) {
  const ErrorUnit unit = c.request.error_unit();
  const auto fixed = [&unit](double error) { return unit.fixed(error, 5); };
  const std::string noise = fmt::format("noise of {}", c.candidates.front().runs.back().samples);
  Table table{"summary"};
  for (size_t i = 0; i < c.candidates.size(); ++i) {
    const CandidateResult& s = c.candidates[i];
    const CandidateRun& r = s.runs.back();
    const RenderError& e = r.errors[kAll][kTogether];
    const SpeedUps v = speed_ups(c, i);
    const bool told = v.equal_error_at_bias && v.equal_error_at_bias->value > 0;
    table.add("candidate", s.candidate.label);
    table.add("CPU s/sample", fmt::format("{:.3g}", r.cost.cpu_seconds / double(r.samples)));
    table.add("bias (95 %)", fmt::format("{} ({} to {})", fixed(e.bias.root()), fixed(e.bias.root_at(-kZ95)),
                                         fixed(e.bias.root_at(kZ95))));
    table.add(noise, fixed(e.noise.root()));
    table.add("FLIP", r.flip ? fmt::format("{:.4f}", *r.flip) : "-");
    table.add("equal samples", fmt::format("{:.2f}", v.equal_samples));
    table.add("equal error", told ? fmt::format("{:.2f}", v.equal_error_at_bias->value) : "-");
    table.add("equal noise", fmt::format("{:.2f}", v.equal_noise));
  }
  return to_text(table) + (unit.is_relative() ? fmt::format("{}\n", kRelativeExplained) : "") +
         fmt::format(
             "Last three columns: speed-up over {} (its CPU time divided by the candidate's) for an equal number "
             "of samples; until\nthe RMS error is 1.5 times the candidate's bias (-: it has none, or {} does not "
             "reach that error); for equal noise.\n",
             c.candidates.front().candidate.label, c.candidates.front().candidate.label);
}

}  // namespace frond::compare
