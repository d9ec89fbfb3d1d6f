#include "leaf/table/mode_table_file.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/messages/counted.h"
#include "leaf/table/mode_lookup.h"
#include "system/file_bytes.h"

namespace frond::leaf {
namespace {

constexpr std::string_view kSides[] = {"adaxial", "abaxial"}, kWays[] = {"reflected", "transmitted"};
constexpr size_t kMostModes = 64;

struct Word {
  std::string_view text;
  Location where;
};

/// Splits a text into lines of words, without comments and empty lines.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name)
      : rest_(text), here_{std::make_shared<const std::string>(name), 0, 1} {
    next();
  }

  bool at_end() const { return words_.empty(); }
  const Word& first() const { return words_[0]; }
  const Location& end() const { return here_; }
  /// Returns the line's words; requires this number of them.
  std::vector<Word> take(size_t count, std::string_view what) {
    if (at_end()) fail(here_, "the file ends before {}", what);
    if (words_.size() != count)
      fail(words_[std::min(count, words_.size() - 1)].where, "{} in place of {}", counted(words_.size(), "word"), what);
    std::vector<Word> line = std::exchange(words_, {});
    next();
    return line;
  }

 private:
  void next() {
    words_.clear();
    while (words_.empty() && !rest_.empty()) {
      ++here_.line;
      const size_t length = std::min(rest_.find('\n'), rest_.size());
      split(rest_.substr(0, length));
      rest_.remove_prefix(std::min(length + 1, rest_.size()));
    }
  }
  void split(std::string_view line) {
    constexpr std::string_view kSpace = " \t\r";
    for (size_t end = 0;;) {
      const size_t begin = line.find_first_not_of(kSpace, end);
      if (begin == line.npos || line[begin] == '#') return;
      end = std::min(line.find_first_of(kSpace, begin), line.size());
      words_.push_back({line.substr(begin, end - begin), here_});
      words_.back().where.column = static_cast<int>(begin) + 1;
    }
  }

  std::string_view rest_;
  Location here_;
  std::vector<Word> words_;
};

void expect(const Word& word, std::string_view text) {
  if (word.text != text) fail(word.where, "\"{}\" is expected here, not \"{}\"", text, word.text);
}

template <class T>
T number(const Word& word, std::string_view what) {
  T value{};
  const auto [end, error] = std::from_chars(word.text.data(), word.text.data() + word.text.size(), value);
  if (error != std::errc() || end != word.text.data() + word.text.size())
    fail(word.where, "{} is a number, \"{}\" was given", what, word.text);
  return value;
}

double number_in(const Word& word, std::string_view what, double low, double high) {
  const double value = number<double>(word, what);
  if (!(value >= low && value <= high)) fail(word.where, "{} is from {} to {}, {} was given", what, low, high, value);
  return value;
}

size_t count_in(const Word& word, std::string_view what, size_t high) {
  const auto value = number<size_t>(word, what);
  if (value < 1 || value > high) fail(word.where, "{}: 1 to {}, {} was given", what, high, value);
  return value;
}

/// One mode. The file has the sines from 0 on; nodes at negative sines are mirror images.
LeafModes::Grid read_mode(Lines& lines, size_t mode, size_t side) {
  LeafModes::Grid grid(side * side);
  const double mirror = mode % 2 == 1 ? -1 : 1;
  for (size_t i = 1; i < side; ++i) {
    const auto row =
        lines.take(side - 1, fmt::format("the {} numbers of mode {} for an angle of incidence", side - 1, mode));
    for (size_t o = 1; o < side; ++o) {
      const double value = number<double>(row[o - 1], "a mode");
      if (!std::isfinite(value)) fail(row[o - 1].where, "{} is not a finite number", row[o - 1].text);
      if (mode == 0 && value < 0)
        fail(row[o - 1].where, "mode 0 is a mean over azimuth and not below 0, {} was given", value);
      grid[i * side + o] = value;
    }
    grid[i * side] = mirror * grid[i * side + 2];
  }
  for (size_t o = 0; o < side; ++o) grid[o] = mirror * grid[2 * side + o];
  return grid;
}

ModeTableColumn read_column(Lines& lines, ModeTable& spectrum) {
  const auto head = lines.take(6, "wavelength_nm NM index N depth D");
  expect(head[0], "wavelength_nm"), expect(head[2], "index"), expect(head[4], "depth");
  constexpr double kMost = 1e30;
  const ModeTableColumn column{number_in(head[1], "wavelength_nm", 1, 1e6), number_in(head[5], "depth", 0, kMost),
                               head[0].where};
  spectrum.index.push_back(number_in(head[3], "index", 1.001, 10));
  LeafModes modes(grid_sines(spectrum.cells));
  for (const bool below : {false, true})
    for (const bool crosses : {false, true}) {
      const auto line = lines.take(4, fmt::format("{} {} modes M", kSides[below], kWays[crosses]));
      expect(line[0], kSides[below]), expect(line[1], kWays[crosses]), expect(line[2], "modes");
      const size_t count = count_in(line[3], "modes", kMostModes);
      for (size_t m = 0; m < count; ++m)
        modes.series(below, crosses).push_back(read_mode(lines, m, modes.sines().size()));
    }
  spectrum.modes.push_back(std::move(modes));
  return column;
}

/// Checks that no more light leaves than has passed the surface, apart from the errors of interpolation and of the
/// quadrature rule.
void check_energy(const ModeTableFile& file, size_t column) {
  const ModeTable& all = file.spectrum;
  const ModeTable alone{all.cells, {all.index[column]}, {all.modes[column]}};
  const double lambda_nm = file.columns[column].lambda_nm;
  const ModeLookup table({.params = {}, .wavelengths_nm = {lambda_nm}, .tolerance = 0}, alone, false);
  TableSelection first;
  first.lane_count = first.columns_per_lane = 1;
  first.lanes[0].weight[0] = 1;
  constexpr double kRule = 1e-3;
  for (const bool below : {false, true})
    for (int i = 0; i <= all.cells; ++i) {
      const double sine = static_cast<double>(i) / all.cells;
      const ModeLookup::Ways ways =
          table.ways(below, table.nodes(static_cast<float>(sine)), SampledSpectrum(1).v, first);
      const double sum = static_cast<double>(ways.back + ways.across);
      if (sum > 1 + kRule + 2 * all.error)
        fail(file.columns[column].where,
             "of light that enters the {} side at {:.1f} degrees {:.4f} leaves the leaf: more than has entered",
             kSides[below], std::asin(sine) * 180 / std::numbers::pi, sum);
    }
}

void write_series(std::string& text, const LeafModes& modes, bool below, bool crosses) {
  const size_t side = modes.sines().size();
  const auto& series = modes.series(below, crosses);
  fmt::format_to(std::back_inserter(text), "{} {} modes {}\n", kSides[below], kWays[crosses], series.size());
  for (const LeafModes::Grid& h : series)
    for (size_t i = 1; i < side; ++i)
      fmt::format_to(std::back_inserter(text), "{}\n",
                     fmt::join(h.begin() + ptrdiff_t(i * side + 1), h.begin() + ptrdiff_t((i + 1) * side), " "));
}

LeafModes::Grid blend(const LeafModes::Grid& a, const LeafModes::Grid& b, double t) {
  const size_t size = std::max(a.size(), b.size());  // a mode that one of them lacks is 0
  LeafModes::Grid result(size);
  for (size_t i = 0; i < size; ++i) result[i] = (1 - t) * (a.empty() ? 0 : a[i]) + t * (b.empty() ? 0 : b[i]);
  return result;
}

LeafModes blend(const LeafModes& a, const LeafModes& b, double t) {
  if (t == 0 || t == 1) return t == 0 ? a : b;  // so that modes of weight 0 are not added
  LeafModes result(a.sines());
  for (const bool below : {false, true})
    for (const bool crosses : {false, true}) {
      const auto &x = a.series(below, crosses), &y = b.series(below, crosses);
      for (size_t m = 0; m < std::max(x.size(), y.size()); ++m)
        result.series(below, crosses)
            .push_back(blend(m < x.size() ? x[m] : LeafModes::Grid(), m < y.size() ? y[m] : LeafModes::Grid(), t));
    }
  return result;
}

/// Sorts columns by wavelength, then by depth.
std::vector<ModeTableColumn> columns_of(const ModeTableRequest& request) {
  const TissueModel model(request.params);
  std::vector<ModeTableColumn> columns;
  for (const double nm : request.wavelengths_nm) {
    if (request.depths.empty()) columns.push_back({nm, model.at(nm).mesophyll_depth(), {}});
    for (const double depth : request.depths.depths()) columns.push_back({nm, depth, {}});
  }
  return columns;
}

/// Requires one column for each wavelength: a render's leaf without depths.
void check_wavelengths(const ModeTableFile& file) {
  for (size_t i = 0; i < file.columns.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (file.columns[i].lambda_nm == file.columns[j].lambda_nm)
        fail(file.columns[i].where, "{} nm is given twice, first in line {}", file.columns[i].lambda_nm,
             file.columns[j].where.line);
}

}  // namespace

std::vector<double> ModeTableFile::wavelengths_nm() const {
  std::vector<double> nm;
  for (const ModeTableColumn& column : columns) nm.push_back(column.lambda_nm);
  return nm;
}

std::string to_text(const ModeTableRequest& request, const ModeTable& spectrum, std::string_view header) {
  const std::vector<ModeTableColumn> columns = columns_of(request);
  std::string text = fmt::format("{}cells {}\nerror {}\n", header, spectrum.cells, spectrum.error);
  for (size_t c = 0; c < columns.size(); ++c) {
    fmt::format_to(std::back_inserter(text), "wavelength_nm {} index {} depth {}\n", columns[c].lambda_nm,
                   spectrum.index[c], columns[c].depth);
    for (const bool below : {false, true})
      for (const bool crosses : {false, true}) write_series(text, spectrum.modes[c], below, crosses);
  }
  return text;
}

ModeTableFile parse_mode_table_file(std::string_view text, const std::string& name) {
  const Location start{std::make_shared<const std::string>(name), 1, 1};
  if (text.find('\0') != text.npos) fail(start, "not a text file: a mode table is a text file");
  Lines lines(text, name);
  ModeTableFile file;
  const auto cells = lines.take(2, "cells N");
  expect(cells[0], "cells");
  file.spectrum.cells = static_cast<int>(count_in(cells[1], "cells", kMostCells));
  const auto error = lines.take(2, "error E");
  expect(error[0], "error");
  file.spectrum.error = number_in(error[1], "error", 0, 1e3);
  do {
    file.columns.push_back(read_column(lines, file.spectrum));
    check_energy(file, file.columns.size() - 1);
  } while (!lines.at_end());
  return file;
}

ModeTableFile read_mode_table_file(const std::filesystem::path& path, const Location& where) {
  ModeTableFile file = parse_mode_table_file(read_file_bytes(path, where, "mode table"), path.string());
  check_wavelengths(file);
  return file;
}

ModeTable at_wavelengths(const ModeTableFile& file, const std::vector<double>& wavelengths_nm) {
  std::vector<size_t> order(file.columns.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto nm = [&file](size_t i) { return file.columns[i].lambda_nm; };
  std::ranges::sort(order, {}, nm);
  ModeTable result{.cells = file.spectrum.cells, .error = file.spectrum.error};
  for (const double wanted : wavelengths_nm) {
    const auto after = std::ranges::upper_bound(order, wanted, {}, nm);
    const size_t above = std::min(static_cast<size_t>(after - order.begin()), order.size() - 1);
    const size_t b = order[above], a = order[above > 0 ? above - 1 : 0];
    const double width = nm(b) - nm(a), t = width > 0 ? std::clamp((wanted - nm(a)) / width, 0.0, 1.0) : 0;
    result.index.push_back(std::lerp(file.spectrum.index[a], file.spectrum.index[b], t));
    result.modes.push_back(blend(file.spectrum.modes[a], file.spectrum.modes[b], t));
  }
  return result;
}

}  // namespace frond::leaf
