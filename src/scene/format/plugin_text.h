#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/plugin.h"

namespace frond {

/// A plug-in with parameters as one word of a command line: `hero`, `hero,lambdamin=400,lambdamax=700`, or
/// `bands,wavelengths=450,550,670`. A value without a name continues the list before it.
struct PluginText {
  std::string name;
  std::vector<std::pair<std::string, std::string>> params;
  Location where = {};  ///< of the text, for errors
};

/// Throws InputError at `where` for text of another form.
PluginText parse_plugin_text(const std::string& text, const Location& where);

/// Whether two plug-ins have equal names and parameters; locations are ignored.
bool same_plugin(const ParsedPlugin& a, const ParsedPlugin& b);

/// Returns a parameter as a scene file would contain it. `type`: float or integer.
ParsedParam parsed_numbers(const char* type, const char* name, std::vector<double> values);

/// Adds a parameter, replacing one of the same name.
void set_param(std::vector<ParsedParam>& params, ParsedParam param);

/// Writes the text's parameters into `plugin`, replacing parameters of the same name. Types follow from the
/// declarations in `info`: lists are separated by commas; a spectrum is one number (constant), three (rgb), pairs of
/// wavelength (nm) and value, a spectrum's name, or an .spd file. Throws InputError at `where` for unknown names and
/// values of the wrong type.
void set_params(const PluginText& text, const PluginInfo& info, const Location& where, ParsedPlugin& plugin);

/// Replaces `plugin` by the plug-in of the text. If the name is the same, other parameters are kept. Throws as
/// set_params does.
void override_plugin(const PluginText& text, const PluginInfo& info, const Location& where, ParsedPlugin& plugin);

}  // namespace frond
