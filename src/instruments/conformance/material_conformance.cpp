#include "instruments/conformance/material_conformance.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "instruments/conformance/examination.h"

namespace frond {
namespace {

Hit flat_hit() {
  return {.p = {0.3f, 0.2f, 0.1f}, .ng = {0, 0, 1}, .shading = Frame::around({0, 0, 1}), .at = {{0.5f, 0.5f}}};
}

/// A hit whose shading normal is not the geometric one.
Hit tilted_hit() {
  Hit hit = flat_hit();
  hit.shading = Frame::around(normalize(Vec3{0.5f, -0.3f, 0.8f}));
  return hit;
}

std::string wavelengths_text(const SampledWavelengths& lambda) {
  std::string text;
  for (int i = 0; i < lambda.count; ++i)
    text += fmt::format("{}{:.0f}{}", i == 0 ? "" : " ", lambda.nm[static_cast<size_t>(i)],
                        lambda.is_active(i) ? "" : " (retired)");
  return text + " nm";
}

/// Makes and prepares the material; nullptr if the plug-in refuses the parameters or breaks the law of parameters.
std::unique_ptr<Material> make_ready(const MaterialInfo& info, const ParameterSet& set, bool must_work,
                                     const std::string& where, const MaterialExamination& how, Findings& findings) {
  Finding finding{.law = Law::parameters, .where = where, .message = {}};
  std::unique_ptr<Material> material;
  try {
    const Params params(info, set.plugin, how.resolver);
    material = make_checked(info, {}, [&] { return info.make(params); });
    if (const auto unread = params.unread(); !unread.empty()) {
      finding.message = fmt::format("declared but never read: {}", fmt::join(unread, ", "));
      finding.p_value = 0;
    }
    material->prepare(how.preparation);
  } catch (const InputError& e) {
    material = nullptr;
    if (!must_work) {
      if (how.on_refusal) how.on_refusal(set, e);
      return nullptr;
    }
    if (how.is_asked_for) throw;
    finding.message = fmt::format("refused: {}", e.what());
    finding.p_value = 0;
  } catch (const std::logic_error& e) {
    material = nullptr;
    finding.message = e.what();
    finding.p_value = 0;
  }
  findings.push_back(finding);
  return material;
}

/// Tests the laws of one set of parameters.
void examine_set(const MaterialInfo& info, const ParameterSet& set, bool must_work, const MaterialExamination& how,
                 Arena& arena, Findings& findings) {
  ExaminationEffort effort = how.effort;
  effort.seed = hash_key(effort.seed, hash_bytes(info.name), hash_bytes(set.label));
  const SampledWavelengths lambda = how.preparation.wavelengths.sample(RandomStream(effort.seed).uniform());
  const std::string where = fmt::format("{}: {}; {}", info.name, set.label, wavelengths_text(lambda));
  const auto material = make_ready(info, set, must_work, where, how, findings);
  if (!material) return;
  const Claims claims{how.claims.lossless, how.claims.reciprocal || material->is_reciprocal()};
  arena.reset();
  // `evaluate` returns nullptr for an invisible surface.
  run_guarded(where, findings, [&] {
    const Bsdf* bsdf = material->evaluate(flat_hit(), lambda, arena);
    if (!bsdf) return;
    const Findings more = examine(*bsdf, lambda, claims, effort, where);
    findings.insert(findings.end(), more.begin(), more.end());
  });
  if (const auto* fluorescent = dynamic_cast<const FluorescentMaterial*>(material.get())) {
    std::shared_ptr<const Fluorescence> fluorescence;
    try {
      fluorescence = fluorescent->fluorescence(how.preparation);
    } catch (const InputError&) {  // not computed with these parameters
    }
    if (fluorescence) run_guarded(where, findings, [&] { check_fluorescence(*fluorescence, where, effort, findings); });
  }
  const std::string tilted = where + ", under a tilted shading normal";
  run_guarded(tilted, findings, [&] {
    if (const Bsdf* bsdf = material->evaluate(tilted_hit(), lambda, arena))
      check_edge_cases(*bsdf, tilted, effort.seed, findings);
  });
  if (lambda.count == 1) return;  // a path whose only lane is retired has ended
  SampledWavelengths retired = lambda;
  retired.active[0] = false;
  const std::string partly = fmt::format("{}: {}; {}", info.name, set.label, wavelengths_text(retired));
  run_guarded(partly, findings, [&] {
    if (const Bsdf* bsdf = material->evaluate(flat_hit(), retired, arena))
      check_retired_lanes(*bsdf, retired, partly, effort.seed, findings);
  });
}

}  // namespace

Findings examine(const MaterialInfo& info, std::span<const ParameterSet> sets, const MaterialExamination& how) {
  Findings findings;
  Arena arena;
  for (const ParameterSet& set : sets) {
    const size_t first = findings.size();
    const bool must_work = !how.may_refuse_all && &set == sets.data();
    examine_set(info, set, must_work, how, arena, findings);
    for (Finding& f : std::span(findings).subspan(first)) f.parameters = set.label;
  }
  return findings;
}

}  // namespace frond
