#include "study/compare/candidate.h"

#include <algorithm>

#include "scene/format/words.h"

namespace frond::compare {
namespace {

bool begins_candidate(const std::string& part) {
  const std::string head = part.substr(0, part.find('@'));
  return head.find('=') == std::string::npos;
}

std::vector<std::string> split_candidates(const std::string& text) {
  std::vector<std::string> result;
  for (const std::string& group : split(text, ';')) {
    bool first = true;
    for (const std::string& part : split(group, ',')) {
      if (first || begins_candidate(part))
        result.push_back(part);
      else
        result.back() += ',' + part;
      first = false;
    }
  }
  return result;
}

/// Returns the end of the label: the first colon, unless another separator comes before.
size_t label_end(const std::string& text) {
  const size_t colon = text.find(':');
  return colon < text.find_first_of(",=@") ? colon : std::string::npos;
}

/// Parses `@key=...`, which ends at the next `@` or the end of the text.
void take_override(Candidate& c, const std::string& part, const std::string& whole) {
  const size_t equals = part.find('=');
  const std::string key = part.substr(0, equals), value = equals == std::string::npos ? "" : part.substr(equals + 1);
  if (value.empty() || (key != "wavelengths" && key != "integrator"))
    fail({}, "after @ a candidate has wavelengths=PLUGIN or integrator=PLUGIN: \"@{}\" in {}", part, whole);
  if (key == "wavelengths")
    c.wavelengths = value;
  else
    c.integrator = parse_plugin_text(value, {});
}

}  // namespace

Candidate parse_candidate(const std::string& text) {
  const size_t colon = label_end(text);
  Candidate c;
  c.text = colon == std::string::npos ? text : text.substr(colon + 1);
  c.label = colon == std::string::npos ? text : text.substr(0, colon);
  if (c.label.empty()) fail({}, "a candidate looks like [LABEL:]MATERIAL[,parameter=value...]: \"{}\"", text);
  const auto parts = split(c.text, '@');
  c.material = parse_plugin_text(parts[0], {});
  for (size_t i = 1; i < parts.size(); ++i) take_override(c, parts[i], text);
  return c;
}

std::vector<Candidate> parse_candidates(const std::vector<std::string>& texts) {
  std::vector<Candidate> result;
  for (const std::string& text : texts)
    for (const std::string& one : split_candidates(text)) {
      Candidate c = parse_candidate(one);
      if (std::ranges::any_of(result, [&c](const Candidate& other) { return other.label == c.label; }))
        fail({}, "two candidates are called \"{}\": give one a name, as in \"name:{}\"", c.label, c.text);
      result.push_back(std::move(c));
    }
  return result;
}

}  // namespace frond::compare
