#include "leaf/body_cache.h"

#include <fmt/ranges.h>

#include <charconv>
#include <chrono>
#include <optional>

#include "core/random.h"
#include "leaf/cache_file.h"
#include "leaf/constants.h"
#include "leaf/solver.h"
#include "leaf/table_cache.h"

namespace frond::leaf {
namespace {

/// Numbers of a text, one after the other, whatever white space is between them.
class Numbers {
 public:
  explicit Numbers(std::string_view text) : place_(text.data()), end_(text.data() + text.size()) {}

  template <class T>
  bool read(T& value) {
    skip();
    const auto [after, error] = std::from_chars(place_, end_, value);
    place_ = after;
    return error == std::errc();
  }
  bool at_end() {
    skip();
    return place_ == end_;
  }

 private:
  void skip() {
    while (place_ != end_ && (*place_ == ' ' || *place_ == '\n')) ++place_;
  }
  const char* place_;
  const char* end_;
};

void write_series(std::string& text, const BodyModes& modes, bool from_below, bool crosses) {
  const size_t side = modes.sines().size();
  const auto& series = modes.series(from_below, crosses);
  fmt::format_to(std::back_inserter(text), "{}\n", series.size());
  for (const BodyModes::Grid& h : series)
    for (size_t i = 0; i < side; ++i)
      fmt::format_to(std::back_inserter(text), "{}\n",
                     fmt::join(h.begin() + ptrdiff_t(i * side), h.begin() + ptrdiff_t((i + 1) * side), " "));
}

bool read_series(Numbers& numbers, BodyModes& modes, bool from_below, bool crosses) {
  constexpr size_t kMost = 64;
  const size_t side = modes.sines().size();
  size_t count = 0;
  if (!numbers.read(count) || count > kMost) return false;
  auto& series = modes.series(from_below, crosses);
  series.assign(count, BodyModes::Grid(side * side));
  for (BodyModes::Grid& h : series)
    for (double& value : h)
      if (!numbers.read(value)) return false;
  return true;
}

std::string summary(const BodyRequest& request, std::string_view name, const BodySpectrum& spectrum) {
  const std::string depths = request.depths.empty() ? "" : fmt::format(" x {} depths", request.depths.depths().size());
  return fmt::format("leaf modes: {}, {} wavelengths{} x {} cells, error of pi f <= {:.1e}", name,
                     request.wavelengths_nm.size(), depths, spectrum.cells, spectrum.error + request.tolerance / 2);
}

}  // namespace

std::string describe(const BodyRequest& request) {
  std::string text =
      fmt::format("# leaf modes\n{}# solver {}, modes {}, constants {:016x}, tolerance {}\n", describe(request.params),
                  kSolverVersion, kModesVersion, constants_hash(), request.tolerance);
  text += fmt::format("# wavelengths_nm {}\n", list_text(request.wavelengths_nm));
  if (!request.depths.empty()) text += fmt::format("# depths {}\n", fmt::join(request.depths.depths(), ","));
  return text;
}

std::string to_text(const BodySpectrum& spectrum, std::string_view header) {
  std::string text = fmt::format("{}{} {} {} {}\n{}\n", header, spectrum.cells, spectrum.index.size(),
                                 spectrum.modes.size(), spectrum.error, fmt::join(spectrum.index, " "));
  for (const BodyModes& modes : spectrum.modes)
    for (const bool from_below : {false, true})
      for (const bool crosses : {false, true}) write_series(text, modes, from_below, crosses);
  return text;
}

bool parse_body_spectrum(std::string_view text, std::string_view header, BodySpectrum& spectrum) {
  if (!text.starts_with(header)) return false;
  Numbers numbers(text.substr(header.size()));
  size_t wavelengths = 0, columns = 0;
  if (!numbers.read(spectrum.cells) || !numbers.read(wavelengths) || !numbers.read(columns) ||
      !numbers.read(spectrum.error))
    return false;
  const bool sane = spectrum.cells > 0 && spectrum.cells <= kMostCells && wavelengths <= text.size() &&
                    columns <= text.size();  // each takes a character at least
  if (!sane) return false;
  spectrum.index.resize(wavelengths);
  for (double& n : spectrum.index)
    if (!numbers.read(n)) return false;
  spectrum.modes.assign(columns, BodyModes(grid_sines(spectrum.cells)));
  for (BodyModes& modes : spectrum.modes)
    for (const bool from_below : {false, true})
      for (const bool crosses : {false, true})
        if (!read_series(numbers, modes, from_below, crosses)) return false;
  return numbers.at_end();
}

BodySpectrum cached_body_spectrum(const BodyRequest& request, std::string_view name, const ThreadPool& pool,
                                  const Log& log, const std::filesystem::path& cache_dir) {
  const std::string header = describe(request);
  const auto path = cache_dir / fmt::format("leaf-{:016x}.modes", hash_bytes(header));
  BodySpectrum spectrum;
  std::error_code error;  // a cache that cannot be looked into is none
  if (!cache_dir.empty() && std::filesystem::is_regular_file(path, error)) {
    const std::string text = read_file(path);
    if (parse_body_spectrum(without_checksum(text), header, spectrum)) {
      log.info(summary(request, name, spectrum) + ", from the cache");
      return spectrum;
    }
    log.warn({}, fmt::format("{} is damaged, its modes are made anew", path.string()));
  }
  const auto start = std::chrono::steady_clock::now();
  spectrum = make_body_spectrum(request, pool);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  log.info(summary(request, name, spectrum) + fmt::format(", {:.2g} s", seconds.count()));
  if (!cache_dir.empty() && !write_file(path, with_checksum(to_text(spectrum, header))))
    log.warn({}, fmt::format("cannot write {}: the modes are made anew next time", path.string()));
  return spectrum;
}

}  // namespace frond::leaf
