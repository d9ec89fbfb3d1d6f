#pragma once

#include <string>
#include <string_view>

#include "core/log.h"
#include "scene/format/description_builder.h"
#include "scene/format/parameter_list.h"
#include "scene/format/tokenizer.h"

namespace frond {

/// Input and output of a directive.
struct DirectiveContext {
  Tokenizer& tokens;
  ParameterReader& parameters;
  DescriptionBuilder& scene;
  const Log& log;
};

/// Reads the arguments of directive `name`, whose word has been consumed, and executes it. Include and Import are
/// handled by the parser. Throws InputError, also for unknown directives.
void execute(const Token& name, DirectiveContext& context);

/// Throws InputError if the first token of an included file is neither a directive nor a misspelt one: the file is then
/// not part of a scene, and one error is enough. `where`: of the token.
void check_begins_scene(const Token& first, const Location& where);

/// Whether the word is a directive, including Include and Import.
bool is_directive(std::string_view word);

/// Returns the quoted string that must follow. Throws InputError, which names the directive.
Token read_quoted(Tokenizer& tokens, std::string_view directive);

}  // namespace frond
