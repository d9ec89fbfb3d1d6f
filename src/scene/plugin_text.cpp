#include "scene/plugin_text.h"

#include <algorithm>
#include <cstdlib>

namespace frond {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  size_t start = 0;
  for (size_t end; (end = text.find(separator, start)) != std::string::npos; start = end + 1)
    parts.push_back(text.substr(start, end - start));
  parts.push_back(text.substr(start));
  return parts;
}

double number(const std::string& name, const std::string& text, const Location& where) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') fail(where, "\"{}\" is a number, {} was given", name, text);
  return value;
}

/// The value as a scene file would have it.
ParsedParam typed(const Param& declared, const std::string& text, const Location& where) {
  ParsedParam p{"", std::string(declared.name), where, where, {}};
  switch (declared.kind) {
    case ParamKind::boolean:
      if (text != "true" && text != "false") fail(where, "\"{}\" is true or false, {} was given", p.name, text);
      p.type = "bool";
      p.values = std::vector<bool>{text == "true"};
      return p;
    case ParamKind::string:
      p.type = "string";
      p.values = std::vector<std::string>{text};
      return p;
    case ParamKind::integer:
    case ParamKind::real:
    case ParamKind::float_texture:
      p.type = declared.kind == ParamKind::integer ? "integer" : "float";
      p.values = std::vector<double>{number(p.name, text, where)};
      return p;
    default:
      fail(where, "\"{}\" cannot be given on the command line: write it in the scene", p.name);
  }
}

}  // namespace

PluginText parse_plugin_text(const std::string& text, const Location& where) {
  const auto parts = split(text, ',');
  PluginText result{parts[0], {}};
  if (result.name.empty()) fail(where, "a plugin's name and parameters look like NAME,parameter=value: {}", text);
  for (size_t i = 1; i < parts.size(); ++i) {
    const size_t equals = parts[i].find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == parts[i].size())
      fail(where, "a parameter looks like name=value: \"{}\" in {}", parts[i], text);
    result.params.emplace_back(parts[i].substr(0, equals), parts[i].substr(equals + 1));
  }
  return result;
}

void set_params(const PluginText& text, const PluginInfo& info, const Location& where, ParsedPlugin& plugin) {
  for (const auto& [name, value] : text.params) {
    const auto declared =
        std::find_if(info.params.begin(), info.params.end(), [&](const Param& p) { return p.name == name; });
    if (declared == info.params.end()) {
      std::vector<std::string_view> names;
      for (const Param& p : info.params) names.push_back(p.name);
      fail(where, "{} \"{}\" has no parameter \"{}\"{}", info.kind, info.name, name, suggestion(name, names));
    }
    std::erase_if(plugin.params, [&](const ParsedParam& p) { return p.name == name; });
    plugin.params.push_back(typed(*declared, value, where));
  }
}

}  // namespace frond
