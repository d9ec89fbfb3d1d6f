#include "leaf/table/mode_table_cache.h"

#include <fmt/ranges.h>

#include <chrono>
#include <optional>

#include "core/log.h"
#include "core/messages/counted.h"
#include "leaf/solve/solver.h"
#include "leaf/table/cache_file.h"
#include "leaf/table/mode_table_file.h"
#include "leaf/table/table_cache.h"
#include "leaf/tissue/leaf_numbers.h"
#include "system/cache_limit.h"

namespace frond::leaf {
namespace {

/// Parses text that `to_text` wrote under the same header; none if it is anything else.
std::optional<ModeTable> parse(std::string_view text, std::string_view header, const ModeTableRequest& request) {
  if (!text.starts_with(header)) return {};
  try {
    ModeTableFile file = parse_mode_table_file(text, "");
    const size_t columns = request.wavelengths_nm.size() * std::max<size_t>(1, request.depths.depths().size());
    if (file.columns.size() == columns) return std::move(file.spectrum);
  } catch (const InputError&) {  // a damaged file is replaced
  }
  return {};
}

}  // namespace

std::string summary(const ModeTableRequest& request, std::string_view name, const ModeTable& spectrum) {
  const std::string depths = request.depths.empty() ? "" : " x " + counted(request.depths.depths().size(), "depth");
  return fmt::format("mode table: {}, {}{}, BSDF error at most {:.1e} of a white Lambertian surface's", name,
                     counted(request.wavelengths_nm.size(), "wavelength"), depths,
                     spectrum.error + request.tolerance / 2);
}

std::string describe(const ModeTableRequest& request) {
  std::string text =
      fmt::format("# mode table (docs/file_formats.md)\n{}# solver {}, modes {}, constants {:016x}, tolerance {}\n",
                  describe(request.params), kSolverVersion, kModesVersion, constants_hash(), request.tolerance);
  text += fmt::format("# wavelengths_nm {}\n", list_text(request.wavelengths_nm));
  if (request.nodes > 0) text += fmt::format("# nodes {}\n", request.nodes);
  if (!request.depths.empty()) text += fmt::format("# depths {}\n", fmt::join(request.depths.depths(), ","));
  return text;
}

ModeTable cached_mode_table(const ModeTableRequest& request, std::string_view name, const ThreadPool& pool,
                            const Log& log, const std::filesystem::path& cache_dir) {
  const std::string header = describe(request);
  const auto path = cache_path(cache_dir, header, "modes");
  if (const auto text = read_cached(path, log)) {
    if (auto spectrum = parse(without_checksum(*text), header, request)) {
      mark_as_used(path);
      log.info(summary(request, name, *spectrum) + ", from the cache");
      return std::move(*spectrum);
    }
    log.warn({}, fmt::format("{} is damaged, its mode table is computed again", path.string()));
  }
  const auto start = std::chrono::steady_clock::now();
  ModeTable spectrum = make_mode_table(request, pool);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  log.info(summary(request, name, spectrum) + fmt::format(", {:.2g} s", seconds.count()));
  if (!path.empty()) write_cached(path, with_checksum(to_text(request, spectrum, header)), log);
  return spectrum;
}

}  // namespace frond::leaf
