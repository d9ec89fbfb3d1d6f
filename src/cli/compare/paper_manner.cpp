#include "cli/compare/paper_manner.h"

#include <algorithm>

namespace frond::compare {
namespace {

bool declares(const PluginInfo& info, std::string_view name) {
  return std::ranges::any_of(info.params, [name](const Param& p) { return p.name == name; });
}

void set(PluginText& text, const std::string& name, const std::string& value) {
  std::erase_if(text.params, [&name](const auto& p) { return p.first == name; });
  text.params.emplace_back(name, value);
}

std::string text_of(const PluginText& plugin) {
  std::string text = plugin.name;
  for (const auto& [name, value] : plugin.params) text += fmt::format(",{}={}", name, value);
  return text;
}

}  // namespace

std::optional<Candidate> in_the_papers_manner(const Candidate& candidate, const Study& study) {
  Candidate c = candidate;
  if (!c.integrator) c.integrator = PluginText{study.integrator(), {}};
  const IntegratorInfo& integrator = study.registry().integrators.get(c.integrator->name, {});
  if (!declares(integrator, "termination") || !declares(integrator, "cutoff")) return {};
  set(*c.integrator, "termination", "attenuation");
  set(*c.integrator, "cutoff", "0.01");
  if (declares(study.registry().materials.get(c.material.name, {}), "surfacedirect"))
    set(c.material, "surfacedirect", "false");
  c.text = text_of(c.material) + (c.wavelengths.empty() ? "" : "@wavelengths=" + c.wavelengths) +
           "@integrator=" + text_of(*c.integrator);
  return c;
}

}  // namespace frond::compare
