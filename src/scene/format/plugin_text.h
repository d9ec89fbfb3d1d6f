#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/plugin.h"

namespace frond {

/// A plugin with parameters in one word of a command line: `hero`, `hero,lambdamin=400,lambdamax=700`, or
/// `bands,wavelengths=450,550,670`: what has no name of its own goes on with the list before it.
struct PluginText {
  std::string name;
  std::vector<std::pair<std::string, std::string>> params;
};

/// Throws InputError at `where` when the text has another form.
PluginText parse_plugin_text(const std::string& text, const Location& where);

/// Of this name; nullptr where there is none.
const Param* find_param(const PluginInfo& info, std::string_view name);
const ParsedParam* find_param(const std::vector<ParsedParam>& params, std::string_view name);

/// Whether two say the same, wherever they stand.
bool same_plugin(const ParsedPlugin& a, const ParsedPlugin& b);

/// As a scene file has it. `type`: float or integer.
ParsedParam parsed_numbers(const char* type, const char* name, std::vector<double> values);

/// In place of one of the same name.
void set_param(std::vector<ParsedParam>& params, ParsedParam param);

/// Puts the text's parameters into `plugin`, in place of those of the same name there; types follow from the
/// declarations of `info`: lists have commas in them, and a spectrum is one number (the same at every wavelength),
/// three (rgb), pairs of wavelength (nm) and value, the name of one, or an .spd file. Throws InputError at `where` for
/// unknown names and for values of the wrong type.
void set_params(const PluginText& text, const PluginInfo& info, const Location& where, ParsedPlugin& plugin);

/// Makes `plugin` what the text names: one of the same name keeps the parameters that the text does not have. Throws
/// as set_params does.
void override_plugin(const PluginText& text, const PluginInfo& info, const Location& where, ParsedPlugin& plugin);

}  // namespace frond
