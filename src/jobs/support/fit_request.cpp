#include "jobs/support/fit_request.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/units/number.h"
#include "leaf/tissue/specimens.h"

namespace frond {
namespace {

/// Units of contents that --fix accepts. "g/cm2" is last: the others end like it.
constexpr leaf::AreaUnit kAreaUnits[] = {leaf::kMicrogramsPerCm2,
                                         {"\u00b5g/cm2", "", leaf::kMicrogramsPerCm2.per_kg_per_m2},
                                         leaf::kMilligramsPerCm2,
                                         leaf::kGramsPerCm2};

/// Returns the parameter of this name that a fit may keep; nullptr if there is none.
const leaf::LeafNumber* find_fixable_number(std::string_view name) {
  // R and T do not depend on the shape of the surface and on the fluorescence, and a fit leaves these as they are.
  const leaf::LeafNumber* n = leaf::find_leaf_number(name);
  return n && n->is_parameter() && n->changes_shares() ? n : nullptr;
}

/// Parses NAME=NUMBER for a parameter or a content per leaf area. Throws InputError.
leaf::FitRequest::Fixed fixed_of(const std::string& word, const std::string& option) {
  const size_t equals = word.find('=');
  const std::string name = word.substr(0, equals);
  const leaf::LeafNumber* parameter = find_fixable_number(name);
  const auto content = std::ranges::find(leaf::area_contents(), name, &leaf::AreaContent::name);
  if (!parameter && content == leaf::area_contents().end()) {
    std::vector<std::string_view> names;
    for (const leaf::LeafNumber& n : leaf::kLeafNumbers)
      if (find_fixable_number(n.name)) names.push_back(n.name);
    for (const leaf::AreaContent& c : leaf::area_contents()) {
      if (name == c.prospect_symbol)
        fail({}, "{}: there is no fit parameter \"{}\"; PROSPECT's {} is {}, as {}={:g}{}", option, name, name, c.name,
             c.name, c.unit.typical, c.unit.name);
      if (!find_fixable_number(c.name)) names.push_back(c.name);
    }
    fail({}, "{}: there is no fit parameter \"{}\"{}", option, name, suggestion(name, names));
  }
  // The unit, if there is one, follows the number without a blank.
  std::string number = equals == word.npos ? "" : word.substr(equals + 1);
  const auto* unit =
      std::ranges::find_if(kAreaUnits, [&](const leaf::AreaUnit& u) { return number.ends_with(u.name); });
  const bool per_area = unit != std::end(kAreaUnits);
  if (per_area) number.resize(number.size() - unit->name.size());
  if (per_area && parameter && parameter->content.name.empty())
    fail({}, "{} {}: {} is not a content per leaf area", option, word, name);
  if (!parameter && !per_area)
    fail({}, "{} {}: a unit is needed, such as {}={:g}{}", option, word, name, content->unit.typical,
         content->unit.name);
  auto value = parse_number(number);
  if (!value || !(*value >= 0) || !std::isfinite(*value))
    fail({}, "{} {}: {}=NUMBER is needed, 0 at least, in the scene's units or with ug/cm2, mg/cm2 or g/cm2", option,
         word, name);
  // Constituents may be 0, extents and numbers of the structure may not.
  const bool is_positive =
      parameter ? parameter->is_fitted() && !parameter->absorbs() : leaf::parts_of(*content).empty();
  if (is_positive && !(*value > 0)) fail({}, "{} {}: {} is above 0", option, word, name);
  return {name, per_area ? *value / unit->per_kg_per_m2 : *value, per_area};
}

/// Throws InputError for parameters that contradict each other.
void check_contradictions(const leaf::FitRequest& request, const std::string& option) {
  const auto given = [&](std::string_view name) {
    return std::ranges::find(request.fixed, name, &leaf::FitRequest::Fixed::name) != request.fixed.end();
  };
  for (const leaf::FitRequest::Fixed& fixed : request.fixed)
    if (fixed.name == "mesophyllfraction" && fixed.value == 0)
      fail({}, "{}: a mesophyll fraction of 0 absorbs nothing", option);
  for (const leaf::AreaContent& content : leaf::area_contents()) {
    // A content that is a parameter too is that parameter, per area; another one gives its parts, or the thickness.
    if (!given(content.name) || find_fixable_number(content.name)) continue;
    std::vector<std::string_view> parts;
    for (const leaf::LeafNumber* part : leaf::parts_of(content)) parts.push_back(part->name);
    if (parts.empty() && given("thickness"))
      fail({}, "{}: {} per area and the mesophyll fraction give the thickness", option, content.name);
    if (std::ranges::any_of(parts, given))
      fail({}, "{}: {} is the sum of {}", option, content.name, fmt::join(parts, " and "));
  }
}

/// Returns the structure of --structure or --like; nullopt: fit both and select the better one. Throws InputError if
/// they contradict each other.
std::optional<leaf::Structure> structure_of(const Arguments& args, const leaf::Specimen* like) {
  using enum leaf::Structure;
  const std::string given = args.text("structure");
  if (!like) return given.empty() ? std::nullopt : std::optional(given == "bifacial" ? bifacial : unifacial);
  const std::string_view own = like->params.structure == bifacial ? "bifacial" : "unifacial";
  if (!given.empty() && given != own)
    fail({}, "{} {} is {}, which contradicts {}", args.spelled("like"), like->name, own, args.spelled("structure"));
  return like->params.structure;
}

}  // namespace

leaf::FitRequest fit_request(const Arguments& args) {
  leaf::FitRequest request;
  request.like = leaf::find_specimen(args.text("like"));
  request.has_prior = request.like != nullptr;
  request.structure = structure_of(args, request.like);
  if (args.given("sieve")) request.sieve = args.text("sieve") == "on";
  for (const std::string& word : args.texts("fix")) {
    leaf::FitRequest::Fixed fixed = fixed_of(word, args.spelled("fix"));
    if (std::ranges::find(request.fixed, fixed.name, &leaf::FitRequest::Fixed::name) != request.fixed.end())
      fail({}, "{}: {} is given twice", args.spelled("fix"), fixed.name);
    request.fixed.push_back(std::move(fixed));
  }
  check_contradictions(request, args.spelled("fix"));
  request.background = args.real("background");
  if (request.like) request.absorption_tables = request.like->params.absorption_tables;
  if (args.given("absorption"))
    request.absorption_tables =
        args.text("absorption") == "baranoski" ? leaf::AbsorptionTables::baranoski : leaf::AbsorptionTables::prospect;
  return request;
}

void check_values(const Arguments& args, const leaf::FitRequest& request, const Location& where) {
  size_t values = 0;
  for (const leaf::LeafMeasurement& r : request.measurements) values += (r.r ? 1 : 0) + (r.t ? 1 : 0);
  // Fewer values than parameters leave the fit undetermined, unless a prior determines the rest.
  const auto all = static_cast<size_t>(std::ranges::count_if(leaf::fit_variables(), [&](const leaf::LeafNumber& v) {
    return !v.only_with || *v.only_with == request.absorption_tables;
  }));
  const size_t free = all - std::min(all, request.fixed.size());
  if (values == 0) fail(where, "there is no value to fit within 360 to 2500 nm");
  if (values < free && !request.has_prior)
    fail(where, "{} values are fewer than the {} parameters to fit: use {} or {}", values, free, args.spelled("fix"),
         args.spelled("like"));
}

}  // namespace frond
