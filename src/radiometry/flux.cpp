#include "radiometry/flux.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "radiometry/flux_state.h"
#include "radiometry/ratio_sums.h"
#include "scene/leaf_models.h"
#include "system/machine.h"

namespace frond {
namespace {

/// Returns the flags of the materials that count as leaves; empty if there are none.
std::vector<uint8_t> leaves_of(const SceneDescription& description, const FluxRequest& request,
                               const Registry& registry) {
  if (!request.energy) return {};
  std::vector<uint8_t> flags = request.leaves.empty() ? leaf_flags(description, registry)
                                                      : counted_materials(description, request.leaves, registry);
  if (std::ranges::count(flags, 0) == std::ssize(flags)) flags.clear();
  return flags;
}

/// Returns the range of all ranges; nullopt if there are none.
std::optional<Interval> range_of(const std::vector<Interval>& ranges) {
  if (ranges.empty()) return {};
  return Interval{std::ranges::min(ranges, {}, &Interval::min).min, std::ranges::max(ranges, {}, &Interval::max).max};
}

/// Returns a text that identifies the request, except target and period.
std::string text_of(const FluxRequest& request) {
  std::string text = "flux";
  if (request.organs) text += fmt::format(" by {}", kOrganKinds[size_t(*request.organs)]);
  if (request.sides) text += " sides";
  if (request.energy) text += fmt::format(" energy, leaves {}", fmt::join(request.leaves, " "));
  for (const Interval& nm : request.ranges_nm) text += fmt::format(" {:g}:{:g}", nm.min, nm.max);
  if (request.irradiance) text += " irradiance " + request.irradiance_name;
  return text;
}

}  // namespace

FluxMeter::FluxMeter(Session& session, SceneDescription description, const FluxRequest& request, const Scene* other) {
  if (description.has_media())
    fail(description.media.front().plugin.where,
         "flux does not trace participating media; brf and render do, by integrator \"volpath\"");
  prepare_for_radiometry(session.registry(), request.wavelengths, request.period, false, description);
  // Light paths do not use the integrator: pilots of its light samples would be wasted.
  ParsedPlugin& integrator = description.integrator;
  if (find_param(session.registry().integrators.get(integrator.name, integrator.where), "lightsamples"))
    set_param(integrator.params, parsed_numbers("integer", "lightsamples", {1}));
  std::vector<uint8_t> is_leaf = leaves_of(description, request, session.registry());
  LoadedScene loaded = session.load(
      std::move(description), {.command = measurement_text(text_of(request), request.target, request.period)}, other);
  refuse_subsurface(loaded);
  const Scene& scene = loaded.scene();
  if (request.energy && scene.wavelengths().bands()[0].response.empty())
    fail({}, "energy is measured in bands with responses: single wavelengths have none");
  const bool lamps = has_lamps(scene.lights());
  const bool outside = std::ranges::any_of(scene.lights(), &Light::is_distant);
  if (lamps && request.irradiance && (request.energy || outside))
    fail({}, "an irradiance replaces the spectrum of light from outside: lamps in the scene have their own");
  // No light of lamps passes a target.
  const Target target = request.target      ? *request.target
                        : lamps && !outside ? Target{0, 1, 0, 1, 0}
                                            : default_target(scene, session.log());
  if (outside) check_target(scene, target);
  std::vector<Interval> ranges_nm = request.ranges_nm;
  if (request.energy && ranges_nm.empty())
    for (const Band& band : scene.wavelengths().bands())
      ranges_nm.push_back({band.response.front().nm, band.response.back().nm});
  const EntryBox entry{target, request.sides ? std::optional(bottom_of(scene)) : std::nullopt};
  HorizontalIrradiance irradiance(loaded, range_of(ranges_nm), entry.target_area());
  LitBands wavelengths(scene.wavelengths(), irradiance, request.irradiance, request.ranges_nm);
  IncidentLight light(scene, std::move(irradiance), wavelengths.sample_for_index(0, 0.5f));
  const size_t materials = loaded.description().materials.size(), bands = scene.wavelengths().bands().size();
  if (request.sides && scene.period()) fail({}, "a periodic scene has no sides through which light could enter");
  state_ = std::make_unique<State>(State{std::move(loaded), entry, std::move(light), std::move(wavelengths), materials,
                                         bands, FluxChannels{bands, request.energy}, std::move(is_leaf)});
  State& s = *state_;
  s.reflectors = reflectors_of(s.scene());
  s.moments.resize(s.quantities() * s.channels.count());
  s.seen.resize(bands);
  s.turns = turns_of(s.scene().wavelengths());
  s.optics_nm = s.scene().wavelengths().range_nm();
  s.ranges_nm = std::move(ranges_nm);
  if (!s.is_leaf.empty()) {
    constexpr size_t kPoints = 1 << 17;
    s.sun = direction_to_sun(s.scene().lights());
    s.leaf_area =
        leaf_area(s.scene(), lamps ? std::nullopt : std::optional(target), s.is_leaf, s.sun, kPoints, session.pool());
  }
  if (!request.organs) return;
  std::vector<std::string> names;
  for (const MaterialDescription& m : s.loaded.description().materials) names.push_back(m.shown_name());
  s.organs = std::make_unique<Organs>(s.scene(), std::move(names), *request.organs);
  const double bytes = double(s.organs->size()) * double(s.organ_channels()) * OrganSums::kCellBytes;
  if (bytes > machine_memory())
    fail({}, "{} organs and {} bands need {:.1f} GB of memory, this machine has {:.1f} GB: use fewer bands",
         s.organs->size(), bands, bytes * 1e-9, machine_memory() * 1e-9);
  s.by_organ = std::make_unique<OrganSums>(s.organs->size(), s.organ_channels());
}

FluxMeter::~FluxMeter() = default;

const Scene& FluxMeter::scene() const { return state_->scene(); }
const Organs* FluxMeter::organs() const { return state_->organs.get(); }

std::vector<MeanError> FluxMeter::sunlit_organs(ThreadPool& pool) const {
  constexpr size_t kLeast = 4, kMost = 1 << 14;
  const State& s = *state_;
  const std::optional<Vec3> sun = direction_to_sun(s.scene().lights());
  if (!sun) return std::vector<MeanError>(s.organs->size(), kUnknown);
  return sunlit_shares(s.scene(), *s.organs, *sun, std::clamp(size_t(paths()) / s.organs->size(), kLeast, kMost), pool);
}

double FluxMeter::target_area() const { return state_->entry.target_area(); }

uint64_t FluxMeter::paths() const { return state_->end - state_->begin; }
uint64_t FluxMeter::end() const { return state_->end; }

void FluxMeter::start_at(uint64_t path) { state_->begin = state_->end = path; }

SumsPart FluxMeter::part() const {
  SumsPart part{state_->loaded.identity(), state_->begin, state_->end, {}};
  for (const auto& array : state_->sums())
    part.arrays.emplace_back(reinterpret_cast<const char*>(array.data()), array.size());
  return part;
}

void FluxMeter::add(const SumsPart& part, const std::string& name) {
  State& s = *state_;
  const std::string difference = s.loaded.identity().difference(part.identity, "this command", '"' + name + '"');
  if (!difference.empty()) fail({}, "\"{}\" is a part of another measurement. {}", name, difference);
  const auto sums = s.sums();
  if (!std::ranges::equal(sums, part.arrays, {}, std::ranges::size, std::ranges::size))
    fail({}, "\"{}\" is damaged: measure it again", name);
  if (s.begin == s.end) start_at(part.begin);
  s.end = part.end;
  add_elements(std::span(s.moments), std::as_bytes(std::span(part.arrays[0])));
  add_elements(std::span(s.seen), std::as_bytes(std::span(part.arrays[1])));
  if (s.by_organ) s.by_organ->add(std::as_bytes(std::span(part.arrays[2])));
}

}  // namespace frond
