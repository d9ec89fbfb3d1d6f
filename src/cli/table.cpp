#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "cli/leaf_words.h"
#include "cli/number_list.h"
#include "cli/table_words.h"
#include "core/log.h"
#include "core/parallel.h"
#include "leaf/table/body_cache.h"
#include "leaf/table/body_file.h"
#include "leaf/table/body_table.h"
#include "leaf/table/portable_leaf.h"
#include "leaf/table/reciprocal_body.h"
#include "leaf/table/table_cache.h"
#include "leaf/table/table_file.h"
#include "leaf/tissue/constants.h"
#include "materials/leaf_params.h"
#include "materials/registry.h"
#include "system/atomic_file.h"
#include "system/cpu_clock.h"

namespace frond {
namespace {

struct TableOptions {
  std::vector<std::string> words;
  std::string specimen, method = "solve", wavelengths, angles = "0:180:1", output, rays = "1e6";
  uint64_t seed = 0;
  int threads = 0, nodes = 0;
  bool equal_sides = false, quiet = false;
};

constexpr PluginInfo kLeaf{"the table of", kSimplified, "", "", kLeafParams};

void check_ascending(const std::vector<double>& theta_deg) {
  for (size_t i = 0; i < theta_deg.size(); ++i) {
    if (!(theta_deg[i] >= 0 && theta_deg[i] <= 180))
      fail({}, "--angles are from 0 to 180 degrees, {} was given", theta_deg[i]);
    if (i > 0 && !(theta_deg[i] > theta_deg[i - 1]))
      fail({}, "--angles ascend, {} comes after {}", theta_deg[i], theta_deg[i - 1]);
  }
}

/// Angles up to 90 and their counterparts on the other side.
std::vector<double> on_both_sides(std::vector<double> theta_deg) {
  if (theta_deg.back() > 90) std::erase_if(theta_deg, [](double theta) { return theta > 90; });
  if (theta_deg.empty()) fail({}, "--equalsides needs angles up to 90");
  for (size_t i = theta_deg.size(); i-- > 0;)
    if (theta_deg[i] < 90) theta_deg.push_back(180 - theta_deg[i]);
  return theta_deg;
}

void check_wavelengths(std::vector<double> wavelengths_nm) {
  for (const double nm : wavelengths_nm)
    if (!leaf::kConstantsRange_nm.contains(nm))
      fail({}, "leaf optics are known from {} to {} nm, --wavelengths has {}", leaf::kConstantsRange_nm.min,
           leaf::kConstantsRange_nm.max, nm);
  std::ranges::sort(wavelengths_nm);
  if (const auto twice = std::ranges::adjacent_find(wavelengths_nm); twice != wavelengths_nm.end())
    fail({}, "--wavelengths has {} twice", *twice);
}

leaf::TableRequest request_of(const TableOptions& options, const std::vector<std::string>& leaf) {
  leaf::TableRequest request{.params = LeafParams(leaf_from_words(kLeaf, leaf)).tissue(),
                             .wavelengths_nm = parse_numbers("--wavelengths", options.wavelengths),
                             .theta_deg = parse_numbers("--angles", options.angles),
                             .seed = options.seed};
  if (options.method == "montecarlo") request.method = leaf::TableMethod::monte_carlo;
  constexpr int kMostRays = 1'000'000'000;
  request.rays = static_cast<int>(parse_count("--rays", options.rays, 1, kMostRays));
  request.nodes = options.nodes;
  check_wavelengths(request.wavelengths_nm);
  check_ascending(request.theta_deg);
  if (options.equal_sides) request.theta_deg = on_both_sides(request.theta_deg);
  return request;
}

void write(const std::string& path, const std::string& text) {
  if (path == "-") {
    fmt::print("{}", text);
    if (std::fflush(stdout) != 0) fail({}, "cannot write the table to standard output");
    return;
  }
  replace_file(path, std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

void make_shares_file(const TableOptions& options, const std::vector<std::string>& leaf) {
  const leaf::TableRequest request = request_of(options, leaf);
  const double start = cpu_seconds();
  leaf::Table table = leaf::make_table(request, ThreadPool(options.threads));
  const double seconds = cpu_seconds() - start;
  std::string header = leaf::describe(request);
  if (options.equal_sides) {
    table = leaf::mean_of_sides(table);
    header += "# mean of both sides\n";
  }
  write(options.output, leaf::to_csv(table, header));
  ConsoleLog(options.quiet)
      .info(leaf::summary(request, options.output, table) + fmt::format(", {:.2g} s of CPU", seconds));
}

leaf::BodyRequest modes_request_of(const TableOptions& options, const std::vector<std::string>& leaf) {
  const MaterialInfo& info = PluginTable<MaterialInfo>("material", builtin_materials()).get(kSolved, {});
  const Params params = leaf_from_words(info, leaf);
  leaf::BodyRequest request{.params = LeafParams(params).tissue(),
                            .wavelengths_nm = parse_numbers("--wavelengths", options.wavelengths),
                            .tolerance = params.real("tolerance"),
                            .nodes = options.nodes};
  check_wavelengths(request.wavelengths_nm);
  return request;
}

void make_modes_file(const TableOptions& options, const std::vector<std::string>& leaf) {
  const leaf::BodyRequest request = modes_request_of(options, leaf);
  const double start = cpu_seconds();
  const leaf::BodySpectrum spectrum = leaf::make_body_spectrum(request, ThreadPool(options.threads));
  const double seconds = cpu_seconds() - start;
  write(options.output, leaf::to_text(request, spectrum, leaf::describe(request)));
  const size_t bytes = leaf::BodyTable(request, spectrum, false).bytes();
  ConsoleLog(options.quiet)
      .info(leaf::summary(request, options.output, spectrum) +
            fmt::format(", {} kB in a render, {:.2g} s of CPU", (bytes + 512) / 1024, seconds));
}

/// For programs that are not frond: docs/leaf_file.md.
void make_leaf_file(const TableOptions& options, const std::vector<std::string>& words) {
  const MaterialInfo& info = PluginTable<MaterialInfo>("material", builtin_materials()).get(kSolved, {});
  const LeafParams leaf(leaf_from_words(info, words));
  if (leaf.incident() == Incident::light)
    fail({},
         "a .leaf file is of incident \"traced\" or \"reciprocal\": \"light\" is the former with its directions "
         "swapped");
  leaf::BodyRequest request = modes_request_of(options, words);
  std::ranges::sort(request.wavelengths_nm);
  if (leaf.is_reciprocal()) request.tolerance /= leaf::kReciprocalFiner;
  request.params.cuticle_aspect = 0;
  leaf::BodySpectrum spectrum = leaf::make_body_spectrum(request, ThreadPool(options.threads));
  if (leaf.is_reciprocal()) spectrum = leaf::make_reciprocal(spectrum).value();
  const leaf::PortableLeaf table = leaf::make_portable(request, spectrum, leaf.tissue().cuticle_aspect);
  const std::string bytes = leaf::portable_bytes(table);
  write(options.output, bytes);
  ConsoleLog(options.quiet)
      .info(fmt::format("{}: {}{} wavelengths x {} cells, {} kB", options.output,
                        table.is_reciprocal ? "reciprocal, " : "", table.wavelengths_nm.size(), table.cells,
                        (bytes.size() + 512) / 1024));
}

/// Options that say nothing of a table of modes.
void check_modes_options(const CLI::App& command) {
  for (const char* name : {"--method", "--angles", "--rays", "--seed", "--equalsides"})
    if (command.count(name) > 0)
      fail({}, "{} is for tables of {}; those of {} follow from its \"tolerance\"", name, kSimplified, kSolved);
}

/// Options that the method does not look at.
void check_method_options(const TableOptions& options, const CLI::App& command) {
  const auto refuse = [&command](const char* name, const char* method) {
    if (command.count(name) > 0) fail({}, "{} is for --method {}", name, method);
  };
  if (options.method == "montecarlo") return refuse("--nodes", "solve");
  refuse("--rays", "montecarlo");
  refuse("--seed", "montecarlo");
}

void make_table_file(const TableOptions& options, const CLI::App& command) {
  if (options.output != "-") check_replaceable(options.output);  // now, not after the walks
  const TableWords words = parse_table_words(options.words, options.specimen);
  if (words.material == kSolved) {
    check_modes_options(command);
    if (options.output.ends_with(".leaf")) return make_leaf_file(options, words.leaf);
    return make_modes_file(options, words.leaf);
  }
  check_method_options(options, command);
  make_shares_file(options, words.leaf);
}

}  // namespace

void add_table_command(CLI::App& app) {
  auto options = std::make_shared<TableOptions>();
  TableOptions& o = *options;
  auto* command =
      app.add_subcommand("table", "Write the table that a leaf material looks up, as a file that it can read.");
  command
      ->add_option("leaf", o.words,
                   "[MATERIAL] name=value ...: leaf_simplified (default), R and T by angle and wavelength as CSV, or "
                   "leaf_solved, the modes of its BSDF, or with an output FILE.leaf all of it for other programs "
                   "(docs/leaf_file.md); and the leaf, as they take it (frond describe).")
      ->type_name("MATERIAL");
  command->add_option("--specimen", o.specimen, "A leaf from the literature; soybean by default.")
      ->type_name("SPECIMEN");
  command->add_option("--method", o.method, "solve: without noise. montecarlo: random walks, as published.")
      ->check(CLI::IsMember({"solve", "montecarlo"}));
  command->add_option("--wavelengths", o.wavelengths, "In nm: 608,551,455 or 360:830:5.")->required();
  command->add_option("--angles", o.angles, "Angles of incidence, degrees, above 90 on the abaxial side; 0:180:1.");
  command->add_option("--rays", o.rays, "Walks of montecarlo for each angle and wavelength; 1e6.");
  command
      ->add_option("--nodes", o.nodes,
                   "Of the solution, for each segment of directions; by default as many as it needs.")
      ->check(CLI::Range(2, 200));
  command->add_option("--seed", o.seed, "Seed of the walks of montecarlo.")->check(is_seed);
  command->add_option("--threads", o.threads, "Threads; all by default. The table does not depend on it.")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--equalsides", o.equal_sides, "The mean of both sides, on angles up to 90.");
  command->add_option("-o,--output", o.output, "The table's file; - for standard output.")
      ->type_name("FILE")
      ->required();
  command->add_flag("-q,--quiet", o.quiet, "Print nothing but errors.");
  command->callback([options, command] { make_table_file(*options, *command); });
}

}  // namespace frond
