#include "scene/format/plugin_text.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "scene/format/words.h"

namespace frond {
namespace {

/// Returns nullopt for text that is not a number as a whole.
std::optional<double> number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') return {};
  return value;
}

/// Parses a comma-separated list. Throws InputError.
std::vector<double> numbers(const std::string& name, const std::string& text, const Location& where) {
  std::vector<double> values;
  for (const std::string& part : split(text, ',')) {
    const auto value = number(part);
    if (!value) fail(where, "\"{}\" is a number, {} was given", name, text);
    values.push_back(*value);
  }
  return values;
}

/// Sets a spectrum: one number is constant, three are rgb, pairs are wavelengths (nm) and values; other text is a name
/// or an .spd file.
void set_spectrum(const std::string& text, const Location& where, ParsedParam& p) {
  p.type = "spectrum";
  if (!number(split(text, ',')[0])) {
    p.values = std::vector<std::string>{text};
    return;
  }
  auto values = numbers(p.name, text, where);
  if (values.size() == 1) values = {360, values[0], 2500, values[0]};
  if (values.size() == 3) p.type = "rgb";
  p.values = std::move(values);
}

/// Returns the parameter as a scene file would contain it.
ParsedParam typed(const Param& declared, const std::string& text, const Location& where) {
  ParsedParam p{"", std::string(declared.name), where, where, {}};
  switch (declared.kind) {
    case ParamKind::boolean:
      if (text != "true" && text != "false") fail(where, "\"{}\" is true or false, {} was given", p.name, text);
      p.type = "bool";
      p.values = std::vector<bool>{text == "true"};
      return p;
    case ParamKind::string:
    case ParamKind::material:
      p.type = "string";
      p.values = declared.list ? split(text, ',') : std::vector<std::string>{text};
      return p;
    case ParamKind::illuminant:
    case ParamKind::albedo:
    case ParamKind::unbounded:
    case ParamKind::spectrum_texture:
      set_spectrum(text, where, p);
      return p;
    case ParamKind::integer:
    case ParamKind::real:
    case ParamKind::float_texture:
      p.type = declared.kind == ParamKind::integer ? "integer" : "float";
      p.values = numbers(p.name, text, where);
      return p;
    default:
      fail(where, "\"{}\" cannot be given on the command line: write it in the scene", p.name);
  }
}

}  // namespace

/// A word without "=" continues the previous parameter's list.
PluginText parse_plugin_text(const std::string& text, const Location& where) {
  const auto parts = split(text, ',');
  PluginText result{parts[0], {}, where};
  if (result.name.empty()) fail(where, "a plug-in with parameters is written NAME,parameter=value: {}", text);
  for (size_t i = 1; i < parts.size(); ++i) {
    const size_t equals = parts[i].find('=');
    if (equals == std::string::npos && !parts[i].empty() && !result.params.empty()) {
      result.params.back().second += ',' + parts[i];  // a list continues
      continue;
    }
    if (equals == std::string::npos || equals == 0 || equals + 1 == parts[i].size())
      fail(where, "a parameter looks like name=value: \"{}\" in {}", parts[i], text);
    std::string param = parts[i].substr(0, equals);
    if (std::ranges::find(result.params, param, &std::pair<std::string, std::string>::first) != result.params.end())
      fail(where, "\"{}\" is given twice in {}", param, text);
    result.params.emplace_back(std::move(param), parts[i].substr(equals + 1));
  }
  return result;
}

/// Used to decide whether two scenes can share an object.
bool same_plugin(const ParsedPlugin& a, const ParsedPlugin& b) {
  return a.name == b.name && std::ranges::equal(a.params, b.params, [](const ParsedParam& p, const ParsedParam& q) {
           return p.type == q.type && p.name == q.name && p.values == q.values && p.color_space == q.color_space;
         });
}

ParsedParam parsed_numbers(const char* type, const char* name, std::vector<double> values) {
  return {type, name, {}, {}, std::move(values)};
}

void set_param(std::vector<ParsedParam>& params, ParsedParam param) {
  std::erase_if(params, [&param](const ParsedParam& p) { return p.name == param.name; });
  params.push_back(std::move(param));
}

void set_params(const PluginText& text, const PluginInfo& info, const Location& where, ParsedPlugin& plugin) {
  for (const auto& param : text.params) {
    const std::string &name = param.first, &value = param.second;
    const Param* declared = find_param(info, name);
    if (!declared) {
      std::vector<std::string_view> names;
      for (const Param& p : info.params) names.push_back(p.name);
      fail(where, "{} \"{}\" has no parameter \"{}\"{}", info.kind, info.name, name, suggestion(name, names));
    }
    set_param(plugin.params, typed(*declared, value, where));
  }
}

/// A plug-in of another name loses the old parameters, which it may not have.
void override_plugin(const PluginText& text, const PluginInfo& info, const Location& where, ParsedPlugin& plugin) {
  if (plugin.name != text.name) plugin = {text.name, where, {}};
  set_params(text, info, where, plugin);
}

}  // namespace frond
