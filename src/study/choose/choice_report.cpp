#include "study/choose/choice_report.h"

#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

namespace frond::choose {
namespace {

std::string bias_text(const OptionResult& f, const Answer& answer, double rms) {
  if (f.name == answer.base) return "0: what the others are compared with here";
  return fmt::format("{:.5f} ({:.5f} to {:.5f}){}", f.estimate, f.bias.low, f.bias.high,
                     f.bias.low > rms ? ", too much" : "");
}

std::string answer_text(const Answer& a, double rms) {
  std::string text = a.is_leaf
                         ? fmt::format("  {}, seen first by {:.1f} % of the pixels\n", a.open_choice, 100 * a.share)
                         : fmt::format("  {}\n", a.open_choice);
  for (const OptionResult& f : a.findings)
    text += fmt::format("  {} {:<17}{:>8.2f}{:>8.2f}   {}\n", f.name == a.chosen ? '*' : ' ', f.name, f.price, f.noise,
                        bias_text(f, a, rms));
  for (const Refusal& r : a.refused) text += fmt::format("    {:<17} not for this leaf: {}\n", r.name, r.reason);
  return text;
}

std::string outcome_text(const Choice& c) {
  if (c.ground == Choice::Ground::nothing_meets)
    return fmt::format("{} is taken for every leaf, which is right by definition", c.reference);
  return fmt::format("together: an RMS of {:.5f} at most, with {:.0f} % confidence ({:.5f} at least)", c.bias.high,
                     100 * kConfidence, c.bias.low);
}

/// Returns the options that failed, or were not shown to meet the request.
std::string failures_text(const Choice& c) {
  std::string text;
  for (const Trial& t : c.trials)
    if (t.bias.high > c.rms)
      text += fmt::format("  not enough: {}: an RMS of {:.5f} to {:.5f}\n", fmt::join(t.answers, "; "), t.bias.low,
                          t.bias.high);
  return text;
}

std::string samples_text(const Choice& c) {
  return fmt::format(
      "noise at {} samples per pixel: {:.2g} (RMS); noise and bias together reach {:g} at about {:.0f}, where {} would "
      "take "
      "{:.2g} times the CPU time",
      c.samples, c.noise_rms(), c.rms, c.samples_needed(), c.reference, c.time_saved());
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
  std::string text = fmt::format(
      "leaf models for an RMS of {:g}, by a pilot of {} pixels and 2 x {} samples ({:.2g} s of CPU):\n"
      "                         price   noise   RMS of its bias, alone\n",
      c.rms, c.pilot.pixels, c.pilot_samples, c.pilot.cpu_seconds);
  for (const Answer& a : c.answers) text += answer_text(a, c.rms);
  return text + failures_text(c) + "  " + outcome_text(c) + "\n  " + samples_text(c);
}

std::string choice_sentence(const Choice& c) {
  if (c.ground == Choice::Ground::nothing_meets) return fmt::format("By frond render's pilot {}.", choice_warning(c));
  std::string text = fmt::format("Leaf by leaf, by frond render's pilot, this is enough for an RMS of {:g}: ", c.rms);
  for (size_t i = 0; i < c.answers.size(); ++i)
    text += fmt::format("{}{} for {}", i > 0 ? ", " : "", c.answers[i].chosen, c.answers[i].open_choice);
  return text + fmt::format("; an RMS of {:.2g} at most, with {:.0f} % confidence.", c.bias.high, 100 * kConfidence);
}

std::string choice_warning(const Choice& c) {
  if (c.ground == Choice::Ground::met) return "";
  return fmt::format(
      "no model but {} was shown to keep the image's RMS error below {:g}: the best may have {:.2g}{}", c.reference,
      c.rms, c.trials.back().bias.high,
      c.out_of_samples ? fmt::format(", as far as a pilot of 2 x {} samples can tell", c.pilot_samples) : "");
}

std::map<std::string, std::string> choice_attributes(const Choice& c) {
  std::map<std::string, std::string> attributes;
  for (const Answer& a : c.answers) {
    const OptionResult* chosen = nullptr;
    for (const OptionResult& f : a.findings)
      if (f.name == a.chosen) chosen = &f;
    attributes[a.is_leaf ? "frond:leaf:" + a.open_choice : "frond:chosen_wavelengths"] =
        chosen && a.chosen != a.base ? fmt::format("{}, alone an RMS of {:.5f} at most", a.chosen, chosen->bias.high)
                                     : a.chosen;
  }
  attributes["frond:choice"] =
      c.ground == Choice::Ground::met
          ? fmt::format(
                "RMS against {} at most {:.5f} with {:.0f} % confidence, {:g} asked for; pilot of {} pixels, "
                "2 x {} samples",
                c.reference, c.bias.high, 100 * kConfidence, c.rms, c.pilot.pixels, c.pilot_samples)
          : choice_warning(c);
  return attributes;
}

std::string choice_json(const Choice& c) {
  nlohmann::ordered_json j{{"rms", c.rms},
                           {"confidence", kConfidence},
                           {"met", c.ground == Choice::Ground::met},
                           {"bias", c.bias_estimate},
                           {"bias_low", c.bias.low},
                           {"bias_high", c.bias.high},
                           {"out_of_samples", c.out_of_samples},
                           {"reference", c.reference},
                           {"noise", c.noise_rms()},
                           {"samples_needed", c.samples_needed()},
                           {"reference_samples_needed", c.reference_samples_needed()},
                           {"time_saved", c.time_saved()},
                           {"pilot",
                            {{"pixels", c.pilot.pixels},
                             {"samples", c.pilot_samples},
                             {"paths", c.pilot.paths},
                             {"comparisons", c.comparisons},
                             {"cpu_seconds", c.pilot.cpu_seconds}}}};
  for (const Trial& t : c.trials)
    j["trials"].push_back(
        {{"answers", t.answers}, {"bias_low", t.bias.low}, {"bias_high", t.bias.high}, {"samples", t.samples}});
  for (const Answer& a : c.answers) j[a.is_leaf ? "leaves" : "wavelengths"].push_back(to_json(a));
  return j.dump(-1, ' ', false, decltype(j)::error_handler_t::replace);
}

}  // namespace frond::choose
