#pragma once

#include <string>
#include <string_view>

#include "core/log.h"
#include "scene/format/description_builder.h"
#include "scene/format/parameter_list.h"
#include "scene/format/tokenizer.h"
#include "scene/format/unsupported.h"

namespace frond {

/// What a directive reads its arguments from and writes its meaning to.
struct DirectiveContext {
  Tokenizer& tokens;
  ParameterReader& parameters;
  DescriptionBuilder& scene;
  const Log& log;
  const Unsupported& unsupported;
};

/// Reads the arguments of directive `name`, whose word has been taken from the tokens, and carries it out; all but
/// Include and Import, which are the parser's. Throws InputError, for unknown directives too.
void carry_out(const Token& name, DirectiveContext& context);

/// Whether a word is one, Include and Import too.
bool is_directive(std::string_view word);

/// The quoted string that must come next; `directive` asks for it.
Token read_quoted(Tokenizer& tokens, std::string_view directive);

}  // namespace frond
