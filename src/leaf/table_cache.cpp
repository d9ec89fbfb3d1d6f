#include "leaf/table_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <bit>
#include <charconv>
#include <chrono>
#include <fstream>
#include <iterator>

#include "core/random.h"
#include "leaf/constants.h"
#include "leaf/walk.h"

namespace frond::leaf {
namespace {

std::string_view method_name(TableMethod method) { return method == TableMethod::monte_carlo ? "montecarlo" : "solve"; }

std::string checksum_line(std::string_view text) { return fmt::format("# checksum {:016x}\n", hash_bytes(text)); }

/// Reads what `to_csv` has laid out, from the front of `text`.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  bool skip(std::string_view expected) {
    if (!text_.starts_with(expected)) return good_ = false;
    text_.remove_prefix(expected.size());
    return true;
  }
  double number(char end) {
    double value = 0;
    const auto [stop, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    good_ = good_ && error == std::errc();
    text_.remove_prefix(static_cast<size_t>(stop - text_.data()));
    skip({&end, 1});
    return value;
  }
  bool good() const { return good_; }
  bool at_end() const { return text_.empty(); }

 private:
  std::string_view text_;
  bool good_ = true;
};

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Never leaves half a file under the final name.
bool write_file(const std::filesystem::path& path, const std::string& text) {
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  const auto temporary = std::filesystem::path(path) += fmt::format(".{}.tmp", getpid());
  {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (!out) {
      std::filesystem::remove(temporary, error);
      return false;
    }
  }
  std::filesystem::rename(temporary, path, error);
  return !error;
}

std::string summary(const TableRequest& request, std::string_view name, double error) {
  const bool walks = request.method == TableMethod::monte_carlo;
  return fmt::format("leaf table: {}, {} wavelengths x {} angles, {}{}, {} <= {:.1e}", name,
                     request.wavelengths_nm.size(), Table::kDegrees, method_name(request.method),
                     walks ? fmt::format(" {} rays", request.rays) : "", walks ? "standard error" : "error", error);
}

}  // namespace

std::string describe(const TableRequest& request) {
  const TissueParams& p = request.params;
  std::string text = fmt::format(
      "# leaf table of {}\n# structure {}, thickness {} m, mesophyll fraction {}\n"
      "# kg/m3: chlorophyll a {}, b {}, carotenoids {}, protein {}, cellulose {}, lignin {}\n"
      "# aspect ratios: cuticle {}, epidermis {}, spongy {}, palisade {}; sieve and detour {}\n",
      method_name(request.method), p.structure == Structure::bifacial ? "bifacial" : "unifacial", p.thickness_m,
      p.mesophyll_fraction, p.chlorophyll_a, p.chlorophyll_b, p.carotenoids, p.protein, p.cellulose, p.lignin,
      p.cuticle_aspect, p.epidermis_aspect, p.spongy_aspect, p.palisade_aspect, p.sieve_and_detour);
  for (const Pigment& pigment : p.pigments) {
    uint64_t curve = 0;
    for (const double x : pigment.specific_absorption) curve = hash_key(curve, std::bit_cast<uint64_t>(x));
    text += fmt::format("# pigment {} kg/m3, absorption {:016x}\n", pigment.concentration, curve);
  }
  if (request.method == TableMethod::monte_carlo)
    text += fmt::format("# rays {}, seed {}, walk {}", request.rays, request.seed, kWalkVersion);
  else
    text += fmt::format("# nodes {}, solver {}", kSolverNodes, kSolverVersion);
  text += fmt::format(", constants {:016x}\n# wavelengths_nm", constants_hash());
  for (const double nm : request.wavelengths_nm) text += fmt::format(" {}", nm);
  return text + "\n";
}

std::string to_csv(const Table& table, std::string_view header) {
  std::string text = fmt::format("{}# error {}\ntheta_deg,wavelength_nm,Rs,Rd,T\n", header, table.error);
  for (size_t w = 0; w < table.wavelengths_nm.size(); ++w)
    for (size_t degree = 0; degree < Table::kDegrees; ++degree) {
      const Shares& s = table.at(w, degree);
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", degree, table.wavelengths_nm[w], s.surface,
                     s.subsurface, s.transmitted);
    }
  return text + checksum_line(text);
}

bool from_csv(std::string_view text, std::string_view header, Table& table) {
  const std::string_view last = "# checksum ";
  const size_t body = text.rfind(last);
  if (body == std::string_view::npos || text.substr(body) != checksum_line(text.substr(0, body))) return false;
  Reader in(text.substr(0, body));
  if (!in.skip(header) || !in.skip("# error ")) return false;
  table = {};
  table.error = in.number('\n');
  in.skip("theta_deg,wavelength_nm,Rs,Rd,T\n");
  while (in.good() && !in.at_end()) {
    const double degree = in.number(','), lambda_nm = in.number(',');
    if (degree == 0) table.wavelengths_nm.push_back(lambda_nm);
    const double surface = in.number(','), subsurface = in.number(','), transmitted = in.number('\n');
    table.shares.push_back({surface, subsurface, transmitted});
  }
  return in.good() && table.shares.size() == table.wavelengths_nm.size() * Table::kDegrees;
}

Table cached_table(const TableRequest& request, std::string_view name, const ThreadPool& pool, const Log& log,
                   const std::filesystem::path& cache_dir) {
  const std::string header = describe(request);
  const auto path = cache_dir / fmt::format("leaf-{:016x}.csv", hash_bytes(header));
  Table table;
  std::error_code error;  // a cache that cannot be looked into is none
  if (!cache_dir.empty() && std::filesystem::is_regular_file(path, error)) {
    if (from_csv(read_file(path), header, table)) {
      log.info(summary(request, name, table.error) + ", from the cache");
      return table;
    }
    log.warn({}, fmt::format("{} is damaged, its table is made anew", path.string()));
  }
  const auto start = std::chrono::steady_clock::now();
  table = make_table(request, pool);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  log.info(summary(request, name, table.error) + fmt::format(", {:.2g} s", seconds.count()));
  if (!cache_dir.empty() && !write_file(path, to_csv(table, header)))
    log.warn({}, fmt::format("cannot write {}: the table is made anew next time", path.string()));
  return table;
}

}  // namespace frond::leaf
