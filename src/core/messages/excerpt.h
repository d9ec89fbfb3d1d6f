#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"

namespace frond {

/// Returns the text with its control characters as escapes, such as \n and \x1b: a name or word of a file stays in the
/// line of the message that quotes it, and cannot clear a terminal. InputError and warnings apply this to every
/// message.
std::string escaped(std::string_view text);

/// Returns the text with its control characters as escapes, but for line ends and tabs: for a text of several lines.
std::string printable(std::string_view text);

/// Returns a word of a file as messages quote it: at most 40 characters, or 8 if the file is foreign; "..." follows
/// where it was cut.
std::string excerpt(std::string_view word, const std::filesystem::path& file);
std::string excerpt(std::string_view word, const Location& where);

/// Returns a message about `where`; if the file is foreign, quoted words are replaced by excerpts. InputError and
/// warnings apply this to every message; a word without quotation marks, or about another place, needs `excerpt`.
std::string with_short_quotes(std::string_view message, const Location& where);

/// Marks a file as foreign: a scene names it, and it lies outside the scene's folder. Otherwise the error messages of
/// an untrusted scene could disclose the content of any file of this machine. Thread-safe; a mark is never removed.
void mark_foreign(const std::filesystem::path& file);

/// Whether the file, by any of its names, has been marked as foreign.
bool is_foreign(const std::filesystem::path& file);

}  // namespace frond
