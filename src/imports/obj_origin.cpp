#include "imports/obj_origin.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "core/math/precise_transform.h"

namespace frond {
namespace {

/// Whether a character separates words of a line.
bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// Takes blanks and a number from the beginning of a text. Returns nothing for what is no finite number, or goes on
/// without a blank, as decimals with a comma do.
std::optional<double> take_number(std::string_view& text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return {};
  text.remove_prefix(size_t(end - text.data()));
  if (!text.empty() && !is_blank(text.front())) return {};
  return value;
}

/// Calls `visit` with each line that begins with v, without its end and the v, and `other` with all text between them.
/// Returns false as soon as `visit` does.
template <class Visit, class Other>
bool for_each_vertex(std::string_view text, const Visit& visit, const Other& other) {
  while (!text.empty()) {
    const size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = text.substr(0, end);
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    if (line.size() > 1 && line[0] == 'v' && is_blank(line[1])) {
      if (!visit(line.substr(1))) return false;
    } else {
      other(text.substr(0, end));
    }
    const size_t next = std::min(text.find_first_not_of("\r\n", end), text.size());
    other(text.substr(end, next - end));
    text.remove_prefix(next);
  }
  return true;
}

/// Coordinates of a vertex and the rest of its line, such as colours.
struct Vertex {
  std::array<double, 3> p;
  std::string_view rest;
};
/// Returns nothing for four numbers, which are homogeneous coordinates.
std::optional<Vertex> vertex_of(std::string_view line) {
  Vertex v{};
  for (double& x : v.p) {
    const auto number = take_number(line);
    if (!number) return {};
    x = *number;
  }
  v.rest = line;
  std::string_view after = line;
  if (take_number(after) && !take_number(after)) return {};
  return v;
}

/// Returns the middle value, and sorts in part. There is at least one.
double median(std::vector<double>& values) {
  const auto middle = values.begin() + ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

/// The text is read twice: whether all vertices are far and can be moved is known at its end. Twelve digits of the
/// differences are written: more than a 32-bit float has.
std::array<double, 3> move_obj_to_origin(std::string& text) {
  constexpr double kFewNear = 0.01;
  std::array<std::vector<double>, 3> values;
  size_t near = 0;
  const auto collect = [&](std::string_view line) {
    const auto v = vertex_of(line);
    if (!v) return false;
    near += !is_far({v->p[0], v->p[1], v->p[2]});
    for (size_t axis = 0; axis < 3; ++axis) values[axis].push_back(v->p[axis]);
    return true;
  };
  if (!for_each_vertex(text, collect, [](std::string_view) {}) || double(near) >= kFewNear * double(values[0].size()))
    return {};
  std::array<double, 3> origin{};
  for (size_t axis = 0; axis < 3; ++axis) origin[axis] = std::round(median(values[axis]));
  if (!is_far({origin[0], origin[1], origin[2]})) return {};
  std::string moved;
  moved.reserve(text.size());
  for_each_vertex(
      text,
      [&](std::string_view line) {
        const Vertex v = *vertex_of(line);
        moved += 'v';
        for (size_t axis = 0; axis < 3; ++axis) {
          std::array<char, 32> digits;
          const double x = v.p[axis] - origin[axis];
          const auto end =
              std::to_chars(digits.data(), digits.data() + digits.size(), x, std::chars_format::general, 12);
          moved += ' ';
          moved.append(digits.data(), end.ptr);
        }
        moved += v.rest;
        return true;
      },
      [&](std::string_view other) { moved += other; });
  text = std::move(moved);
  return origin;
}

}  // namespace frond
