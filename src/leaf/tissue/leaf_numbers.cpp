#include "leaf/tissue/leaf_numbers.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "core/math/random.h"

namespace frond::leaf {
namespace {

/// First lines of the heads of tables. Keys of caches and heads of files depend on this text: numbers that were
/// introduced later follow in separate lines, and only if they differ from the published leaf's.
constexpr std::string_view kHead =
    "# structure {structure}, thickness {thickness} m, mesophyll fraction {mesophyllfraction}\n"
    "# kg/m3: chlorophyll a {chlorophylla}, b {chlorophyllb}, carotenoids {carotenoids}, protein {protein}, cellulose "
    "{cellulose}, lignin {lignin}; else 1/m {otherabsorption}\n"
    "# aspect ratios: cuticle {cuticleaspect}, epidermis {epidermisaspect}, spongy {spongyaspect}, palisade "
    "{palisadeaspect}; sieve and detour {sieve}\n";
constexpr std::string_view kProspectHead =
    "# PROSPECT-D's absorption {hash:016x}: {tables}, kg/m3: anthocyanins {anthocyanins}, dry matter {drymatter}\n";

bool contains_placeholder(std::string_view head, const LeafNumber& n) {
  return head.find(fmt::format("{{{}}}", n.name)) != head.npos;
}

}  // namespace

double& TissueParams::number(std::string_view name) {
  const LeafNumber* number = find_leaf_number(name);
  assert(number);
  return number->value(*this);
}

const LeafNumber* find_leaf_number(std::string_view name) {
  const auto found = std::ranges::find(kLeafNumbers, name, &LeafNumber::name);
  return found == kLeafNumbers.end() ? nullptr : &*found;
}

const std::vector<AreaContent>& area_contents() {
  static const std::vector<AreaContent> contents = [] {
    std::vector<AreaContent> all;
    for (const LeafNumber& n : kLeafNumbers) {
      std::erase_if(all, [&](const AreaContent& c) { return c.name == n.content.name; });
      if (!n.content.name.empty()) all.push_back(n.content);
    }
    return all;
  }();
  return contents;
}

std::vector<const LeafNumber*> parts_of(const AreaContent& content) {
  std::vector<const LeafNumber*> parts;
  for (const LeafNumber& n : leaf_parameters())
    if (n.content.name == content.name) parts.push_back(&n);
  return parts;
}

double area_content(const TissueParams& p, const AreaContent& content) {
  double sum = 0;
  for (const LeafNumber& n : kLeafNumbers)
    if (n.content.name == content.name) sum += n.value(p) * n.content.kg_per_m3;
  return area_content(p, sum);
}

std::string describe(const TissueParams& p) {
  const bool prospect = p.absorption_tables == AbsorptionTables::prospect;
  fmt::dynamic_format_arg_store<fmt::format_context> values;
  values.push_back(fmt::arg("structure", p.structure == Structure::bifacial ? "bifacial" : "unifacial"));
  values.push_back(fmt::arg("sieve", p.sieve_and_detour));
  values.push_back(fmt::arg("hash", prospect_hash()));
  values.push_back(fmt::arg("tables", prospect ? "all" : "these"));
  for (const LeafNumber& n : leaf_parameters()) values.push_back(fmt::arg(n.name.data(), n.value(p)));
  std::string text = fmt::vformat(kHead, values);
  if (prospect ||
      std::ranges::any_of(kLeafNumbers, [&p](const LeafNumber& n) { return n.is_of_prospect() && n.value(p) != 0; }))
    text += fmt::vformat(kProspectHead, values);
  static const TissueParams published;
  for (const LeafNumber& n : leaf_parameters()) {
    // Tables of reflectance and transmittance hold for any fluorescence.
    if (n.action == LeafAction::emission || contains_placeholder(kHead, n) || contains_placeholder(kProspectHead, n) ||
        n.value(p) == n.value(published))
      continue;
    text += fmt::format("# {} {}", n.label.empty() ? n.name : n.label, n.value(p));
    if (!n.unit.empty()) text += fmt::format(" {}", n.unit);
    if (!n.spectrum.empty()) text += fmt::format(", absorption {:016x}", hash(n.spectrum));
    text += '\n';
  }
  for (const Pigment& pigment : p.pigments) {
    uint64_t curve = 0;
    for (const double x : pigment.specific_absorption) curve = hash_key(curve, std::bit_cast<uint64_t>(x));
    text += fmt::format("# pigment {} kg/m3, absorption {:016x}\n", pigment.concentration, curve);
  }
  return text;
}

}  // namespace frond::leaf
