#include "study/choose/choice_report.h"

#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

namespace frond::choose {
namespace {

/// An error, in per cent of the means where it is relative.
std::string error_text(const Choice& c, double rms) {
  if (c.is_relative) return fmt::format("{:.2f} %", 100 * rms);
  constexpr double kSmall = 1e-3;  // five decimals would leave two digits
  return rms > 0 && c.rms < kSmall ? fmt::format("{:.1e}", rms) : fmt::format("{:.5f}", rms);
}

std::string request_text(const Choice& c) {
  return c.is_relative ? fmt::format("a relative RMS of {:g} %", 100 * c.rms) : fmt::format("an RMS of {:g}", c.rms);
}

std::string bias_text(const OptionResult& f, const Answer& answer, const Choice& c) {
  if (f.name == answer.reference) return "0: what the others are compared with";
  return fmt::format("{} ({} to {}){}", error_text(c, f.estimate), error_text(c, f.bias.low),
                     error_text(c, f.bias.high), f.bias.low > c.rms ? ", too much" : "");
}

std::string answer_text(const Answer& a, const Choice& c) {
  std::string text = a.is_leaf
                         ? fmt::format("  {}, seen first by {:.1f} % of the pixels\n", a.open_choice, 100 * a.share)
                         : fmt::format("  {}\n", a.open_choice);
  for (const OptionResult& f : a.findings)
    text += fmt::format("  {} {:<17}{:>8.2f}{:>8.2f}   {}\n", f.name == a.chosen ? '*' : ' ', f.name, f.price, f.noise,
                        bias_text(f, a, c));
  for (const Refusal& r : a.refused) text += fmt::format("    {:<17} not for this leaf: {}\n", r.name, r.reason);
  return text;
}

/// "MODEL for near, OTHER for far; hero".
std::string options_text(const Choice& c) {
  std::string text, wavelengths;
  for (const Answer& a : c.answers)
    if (a.is_leaf)
      text += fmt::format("{}{} for {}", text.empty() ? "" : ", ", a.chosen, a.open_choice);
    else
      wavelengths = "; " + a.chosen;
  return text + wavelengths;
}

std::string causes_text(const Choice& c) {
  if (c.answers.front().is_leaf) return "";  // the wavelengths are given
  const auto& shift = c.causes.mean_shift;
  const double scale = c.is_relative ? 100 : 1;
  return fmt::format(
      "\n  by cause: leaves {}; wavelengths {}, with mean changes of R {:+.{}f}, G {:+.{}f}, B {:+.{}f}{}",
      error_text(c, c.causes.leaves), error_text(c, c.causes.wavelengths), scale * shift[0], c.is_relative ? 2 : 5,
      scale * shift[1], c.is_relative ? 2 : 5, scale * shift[2], c.is_relative ? 2 : 5, c.is_relative ? " %" : "");
}

std::string outcome_text(const Choice& c) {
  switch (c.ground) {
    case Choice::Ground::met:
      return fmt::format("together: an RMS of {} at most, with {:.0f} % confidence ({} at least)",
                         error_text(c, c.bias.high), 100 * kConfidence, error_text(c, c.bias.low)) +
             causes_text(c);
    case Choice::Ground::reference:
      return "no cheaper model was shown to meet this" +
             (c.out_of_samples ? fmt::format(" by a pilot of 2 x {} samples", c.pilot_samples) : std::string()) + ": " +
             options_text(c);
    case Choice::Ground::no_gain:
      return "a pilot could take as long as simpler models can save in this render: " + options_text(c);
    case Choice::Ground::no_time:
      return "the time limit ended the pilot: " + options_text(c);
  }
  return "";
}

/// Returns the options that failed, or were not shown to meet the request.
std::string failures_text(const Choice& c) {
  std::string text;
  for (const Trial& t : c.trials)
    if (t.bias.high > c.rms)
      text += fmt::format("  not enough: {}: an RMS of {} to {}\n", fmt::join(t.answers, "; "),
                          error_text(c, t.bias.low), error_text(c, t.bias.high));
  return text;
}

std::string samples_text(const Choice& c) {
  return fmt::format(
      "\n  noise at {} samples per pixel: {} (RMS); noise and bias together reach {} at {}"
      "\n  CPU time of {} samples per pixel, estimated: {:.2g} s, this pilot included; {:.2g} s with the reference",
      c.samples, error_text(c, c.noise_rms()), error_text(c, c.rms),
      c.samples_needed() > kFirstSamples ? fmt::format("about {:.0f}", c.samples_needed())
                                         : fmt::format("{} or fewer", kFirstSamples),
      c.samples, c.net_seconds(), c.reference_seconds);
}

std::string_view ground_name(Choice::Ground ground) {
  constexpr std::string_view kNames[] = {"met", "reference", "no gain", "no time"};
  return kNames[size_t(ground)];
}

nlohmann::ordered_json to_json(const Answer& a) {
  nlohmann::ordered_json j{{"name", a.open_choice}, {"chosen", a.chosen}};
  if (a.is_leaf) j["share"] = a.share;
  for (const OptionResult& f : a.findings)
    j["options"].push_back({{"name", f.name},
                            {"price", f.price},
                            {"noise", f.noise},
                            {"bias", f.estimate},
                            {"bias_low", f.bias.low},
                            {"bias_high", f.bias.high},
                            {"cpu_us_per_path", f.cpu_us_per_path}});
  for (const Refusal& r : a.refused) j["refused"].push_back({{"name", r.name}, {"reason", r.reason}});
  return j;
}

}  // namespace

std::string choice_text(const Choice& c) {
  if (c.answers.front().findings.empty())
    return fmt::format("leaf models for {}: {}", request_text(c), outcome_text(c));
  std::string text = fmt::format(
      "leaf models for {}, by a pilot of {} pixels and 2 x {} samples ({:.2g} s of CPU):\n"
      "                         price   noise   RMS of its bias, alone\n",
      request_text(c), c.pilot.pixels, c.pilot_samples, c.pilot.cpu_seconds);
  for (const Answer& a : c.answers) text += answer_text(a, c);
  return text + failures_text(c) + "  " + outcome_text(c) + (c.has_noise() ? samples_text(c) : "");
}

std::string choice_sentence(const Choice& c) {
  if (c.ground != Choice::Ground::met) return fmt::format("By frond render's pilot {}.", outcome_text(c));
  return fmt::format(
      "Leaf by leaf, by frond render's pilot, this is enough for {}: {}; an RMS of {} at most, with "
      "{:.0f} % confidence.",
      request_text(c), options_text(c), error_text(c, c.bias.high), 100 * kConfidence);
}

std::map<std::string, std::string> choice_attributes(const Choice& c) {
  std::map<std::string, std::string> attributes;
  for (const Answer& a : c.answers) {
    const OptionResult* chosen = nullptr;
    for (const OptionResult& f : a.findings)
      if (f.name == a.chosen) chosen = &f;
    attributes[a.is_leaf ? "frond:leaf:" + a.open_choice : "frond:chosen_wavelengths"] =
        chosen && a.chosen != a.reference
            ? fmt::format("{}, alone an RMS of {} at most", a.chosen, error_text(c, chosen->bias.high))
            : a.chosen;
  }
  attributes["frond:choice"] =
      c.ground == Choice::Ground::met
          ? fmt::format(
                "an RMS of {} at most with {:.0f} % confidence, {} asked for; pilot of {} pixels, 2 x {} samples",
                error_text(c, c.bias.high), 100 * kConfidence, request_text(c), c.pilot.pixels, c.pilot_samples)
          : outcome_text(c);
  return attributes;
}

std::string choice_json(const Choice& c) {
  nlohmann::ordered_json j{{"rms", c.rms},
                           {"relative", c.is_relative},
                           {"confidence", kConfidence},
                           {"ground", ground_name(c.ground)},
                           {"bias", c.bias_estimate},
                           {"bias_low", c.bias.low},
                           {"bias_high", c.bias.high},
                           {"causes",
                            {{"leaves", c.causes.leaves},
                             {"wavelengths", c.causes.wavelengths},
                             {"wavelengths_mean_shift", c.causes.mean_shift}}},
                           {"out_of_samples", c.out_of_samples},
                           {"pilot",
                            {{"pixels", c.pilot.pixels},
                             {"samples", c.pilot_samples},
                             {"paths", c.pilot.paths},
                             {"comparisons", c.comparisons},
                             {"cpu_seconds", c.pilot.cpu_seconds}}}};
  if (c.has_noise())
    j.update({{"noise", c.noise_rms()},
              {"samples_needed", c.samples_needed()},
              {"reference_samples_needed", c.reference_samples_needed()},
              {"net_cpu_seconds", c.net_seconds()},
              {"reference_cpu_seconds", c.reference_seconds}});
  for (const Trial& t : c.trials)
    j["trials"].push_back(
        {{"answers", t.answers}, {"bias_low", t.bias.low}, {"bias_high", t.bias.high}, {"samples", t.samples}});
  for (const Answer& a : c.answers) j[a.is_leaf ? "leaves" : "wavelengths"].push_back(to_json(a));
  return j.dump(-1, ' ', false, decltype(j)::error_handler_t::replace);
}

}  // namespace frond::choose
