#include "spectra/spd_file.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "system/file_bytes.h"

namespace frond {
namespace {

/// Number with its position in the file.
struct Number {
  double value;
  Location where;
};

/// Skips a leading +, which std::from_chars does not accept. The message does not quote the file: a scene could name
/// any file here, and its content would go to whoever sees the log.
double parse_number(std::string_view word, const Location& where) {
  const std::string_view digits = word.substr(word.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size())
    fail(where, "a spectrum file has two numbers in each line, with a blank between: this is not a number");
  return value;
}

/// Appends the numbers of a line; `where` has the line's number.
void parse_line(std::string_view line, Location where, std::vector<Number>& numbers) {
  line = line.substr(0, line.find('#'));
  constexpr std::string_view kSpace = " \t\r\f\v";
  for (size_t begin = 0; (begin = line.find_first_not_of(kSpace, begin)) != line.npos;) {
    const size_t end = std::min(line.find_first_of(kSpace, begin), line.size());
    where.column = static_cast<int>(begin) + 1;
    numbers.push_back({parse_number(line.substr(begin, end - begin), where), where});
    begin = end;
  }
}

std::vector<Number> read_numbers(const std::filesystem::path& path, const Location& where) {
  const std::string text = read_file_bytes(path, where, "spectrum file");
  Location here{std::make_shared<const std::string>(path.string()), 1, 1};
  std::vector<Number> numbers;
  for (std::string_view rest = text; !rest.empty(); ++here.line) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    parse_line(rest.substr(0, end), here, numbers);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (numbers.empty()) fail(here, "the file holds no spectrum: wavelength (nm) and value in turn are expected");
  return numbers;
}

}  // namespace

std::vector<SpectrumPoint> read_spd_points(const std::filesystem::path& path, const Location& where) {
  const std::vector<Number> numbers = read_numbers(path, where);
  if (numbers.size() % 2 != 0)
    fail(numbers.back().where, "wavelength {} nm has no value: the file ends after it", numbers.back().value);
  std::vector<SpectrumPoint> points;
  for (size_t i = 0; i < numbers.size(); i += 2)
    points.push_back({numbers[i].value, numbers[i + 1].value, numbers[i].where});
  check_points(points);
  return points;
}

SpectrumPtr read_spd(const std::filesystem::path& path, const Location& where) {
  return make_tabulated(read_spd_points(path, where));
}

}  // namespace frond
