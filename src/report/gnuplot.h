#pragma once

#include <array>
#include <string>
#include <string_view>

namespace frond {

/// Eight colours that people of any colour vision tell apart (Okabe and Ito 2008), darkest first; their yellow, too
/// faint on paper, gives way to a grey.
inline constexpr std::array<std::string_view, 8> kSeriesColors{"#000000", "#0072b2", "#d55e00", "#009e73",
                                                               "#cc79a7", "#e69f00", "#56b4e9", "#999999"};

/// Refuses, by InputError, a chart that cannot be made: a name that does not end in .svg or .png, a folder that does
/// not take it, no gnuplot.
void check_chart(const std::string& path);

/// Draws by gnuplot, run as a child process with the script and its inline data on its standard input. What the script
/// draws, `width` x `height` pixels, is put at `path`, whole or not at all. Throws InputError with gnuplot's own words.
void write_chart(const std::string& path, int width, int height, const std::string& script);

/// A text as a gnuplot script has it: in quotes within which nothing is special; cut short where it has more bytes than
/// there is room for.
std::string gnuplot_text(std::string_view text, size_t room = 100);

}  // namespace frond
