#include "report/gnuplot.h"

#include <fmt/format.h>

#include "core/error.h"
#include "system/atomic_file.h"
#include "system/child_process.h"

namespace frond {
namespace {

ChildResult run_gnuplot(const std::string& script) {
  // Without the user's own settings, a chart is the same everywhere.
  auto result = run_child({"gnuplot", "--default-settings"}, script);
  if (!result) fail({}, "charts are drawn by gnuplot, which is missing: install it (Debian: gnuplot-nox)");
  return *result;
}

std::string terminal(const std::string& path, int width, int height) {
  const bool svg = path.ends_with(".svg");
  return fmt::format(
      "set encoding utf8\nset terminal {} size {},{} font 'DejaVu Sans,{}' noenhanced background '#ffffff'\n",
      svg ? "svg" : "pngcairo", width, height, svg ? 14 : 11);
}

}  // namespace

void check_chart(const std::string& path) {
  if (!path.ends_with(".svg") && !path.ends_with(".png")) fail({}, "{}: a chart is an .svg or a .png file", path);
  check_replaceable(path);
  run_gnuplot("");
}

void write_chart(const std::string& path, int width, int height, const std::string& script) {
  const ChildResult result = run_gnuplot(terminal(path, width, height) + script + "\nunset output\n");
  if (result.status != 0 || result.out.empty()) fail({}, "gnuplot could not draw \"{}\": {}", path, result.err);
  replace_file(path, {reinterpret_cast<const unsigned char*>(result.out.data()), result.out.size()});
}

std::string gnuplot_text(std::string_view text, size_t room) {
  size_t end = std::min(text.size(), room);
  while (end < text.size() && end > 0 && (text[end] & 0xc0) == 0x80) --end;  // not within a UTF-8 character
  std::string quoted = "'";
  for (const char c : text.substr(0, end)) {
    if (c == '\'') quoted += '\'';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + (end < text.size() ? "…'" : "'");
}

}  // namespace frond
