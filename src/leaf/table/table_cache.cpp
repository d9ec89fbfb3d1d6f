#include "leaf/table/table_cache.h"

#include <fmt/ranges.h>

#include <chrono>

#include "core/log.h"
#include "core/messages/counted.h"
#include "leaf/table/cache_file.h"
#include "leaf/table/table_file.h"
#include "leaf/tissue/leaf_numbers.h"
#include "leaf/walk/walk.h"
#include "system/cache_limit.h"

namespace frond::leaf {
namespace {

std::string_view method_name(TableMethod method) { return method == TableMethod::monte_carlo ? "montecarlo" : "solve"; }

}  // namespace

std::string list_text(const std::vector<double>& values) {
  if (values.size() > 2) {
    const double step = values[1] - values[0];
    if (step > 0 && even_steps(values[0], values.back(), step) == values)
      return fmt::format("{}:{}:{}", values[0], values.back(), step);
  }
  return fmt::format("{}", fmt::join(values, ","));
}

std::string describe(const TableRequest& request) {
  std::string text = fmt::format("# leaf table of {}\n{}", method_name(request.method), describe(request.params));
  if (request.method == TableMethod::monte_carlo)
    text += fmt::format("# rays {}, seed {}, walk {}", request.rays, request.seed, kWalkVersion);
  else
    text +=
        fmt::format("# solver {}{}", kSolverVersion, request.nodes > 0 ? fmt::format(", nodes {}", request.nodes) : "");
  return text + fmt::format(", constants {:016x}\n# wavelengths_nm {}\n# theta_deg {}\n", constants_hash(),
                            list_text(request.wavelengths_nm), list_text(request.theta_deg));
}

std::string summary(const TableRequest& request, std::string_view name, const Table& table) {
  const bool walks = request.method == TableMethod::monte_carlo;
  return fmt::format("leaf table: {}, {} x {}, {}{}, {} at most {:.1e}", name,
                     counted(table.wavelengths_nm.size(), "wavelength"), counted(table.theta_deg.size(), "angle"),
                     method_name(request.method), walks ? fmt::format(" {} rays", request.rays) : "",
                     walks ? "standard error" : "error", table.error);
}

std::string seal(const Table& table, std::string_view header) { return with_checksum(to_csv(table, header)); }

bool unseal(std::string_view text, std::string_view header, Table& table) {
  const std::string_view body = without_checksum(text);
  if (body.empty() || !body.starts_with(header)) return false;
  try {
    table = parse_table(body, "");
    return true;
  } catch (const InputError&) {  // a damaged file is replaced
    return false;
  }
}

Table cached_table(const TableRequest& request, std::string_view name, const ThreadPool& pool, const Log& log,
                   const std::filesystem::path& cache_dir) {
  const std::string header = describe(request);
  const auto path = cache_path(cache_dir, header, "csv");
  Table table;
  if (const auto text = read_cached(path, log)) {
    if (unseal(*text, header, table)) {
      mark_as_used(path);
      log.info(summary(request, name, table) + ", from the cache");
      return table;
    }
    log.warn({}, fmt::format("{} is damaged, its table is computed again", path.string()));
  }
  const auto start = std::chrono::steady_clock::now();
  table = make_table(request, pool);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  log.info(summary(request, name, table) + fmt::format(", {:.2g} s", seconds.count()));
  if (!path.empty()) write_cached(path, seal(table, header), log);
  return table;
}

}  // namespace frond::leaf
