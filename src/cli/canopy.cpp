#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "core/error.h"
#include "core/log.h"
#include "scene/homogeneous_canopy.h"
#include "scene/instance_writer.h"
#include "scene/words.h"

namespace frond {
namespace {

struct CanopyOptions {
  HomogeneousCanopy canopy;
  std::string output, angles = "spherical";
  std::vector<std::string> columns;
  bool quiet = false;
};

const LeafAngles& angles_called(const std::string& name) {
  std::vector<std::string_view> names;
  for (const LeafAngles& a : leaf_angle_distributions()) {
    if (a.name == name) return a;
    names.push_back(a.name);
  }
  fail({}, "--angles: there is no leaf angle distribution \"{}\"{}", name, suggestion(name, names));
}

/// chlorophyll=2:6
HomogeneousCanopy::Column column_of(const std::string& text) {
  const size_t equals = text.find('='), colon = text.find(':', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || colon == std::string::npos)
    fail({}, "--column takes NAME=LEAST:MOST, as in chlorophylla=2:5; \"{}\" was given", text);
  const auto number = [&](const std::string& word) {
    try {
      return std::stod(word);
    } catch (const std::exception&) {
      fail({}, "--column {}: \"{}\" is no number", text, word);
    }
  };
  const Interval range{number(text.substr(equals + 1, colon - equals - 1)), number(text.substr(colon + 1))};
  if (!(range.min <= range.max)) fail({}, "--column {}: {} is more than {}", text, range.min, range.max);
  return {text.substr(0, equals), range};
}

void run_canopy(CanopyOptions o) {
  const ConsoleLog log(o.quiet);
  HomogeneousCanopy& canopy = o.canopy;
  canopy.angles = &angles_called(o.angles);
  if (!(canopy.heights[0] <= canopy.heights[1]))
    fail({}, "--heights: {} is above {}", canopy.heights[0], canopy.heights[1]);
  std::vector<std::string> names;
  for (const std::string& text : o.columns) {
    canopy.columns.push_back(column_of(text));
    names.push_back(canopy.columns.back().name);
  }
  const uint64_t leaves = canopy.leaves();
  constexpr uint64_t kMost = 0xfffffffe;  // of one table, in Embree
  if (leaves == 0 || leaves > kMost) fail({}, "these are {} leaves: 1 to {} can be", leaves, kMost);
  check_replaceable(o.output);
  InstanceWriter writer(o.output, leaves, names);
  LeafPlacer placer(canopy);
  std::vector<float> values(names.size());
  for (uint64_t leaf = 0; leaf < leaves; ++leaf) writer.add(placer.place(values), values);
  writer.finish();
  const double area = double(leaves) * canopy.leaf_area * canopy.scale * canopy.scale;
  const std::string index =
      canopy.ball > 0 ? "" : fmt::format(", leaf area index {:.5g}", area / (canopy.size[0] * canopy.size[1]));
  log.info(fmt::format("{}: {} leaves, {:.6g} of area{}", o.output, leaves, area, index));
}

}  // namespace

void add_canopy_command(CLI::App& app) {
  auto o = std::make_shared<CanopyOptions>();
  auto* command = app.add_subcommand("canopy", "Write a table of leaves at random, for Shape \"instances\".");
  HomogeneousCanopy& c = o->canopy;
  command->add_option("-o,--output", o->output, "The table, a NumPy file (.npy).")->type_name("FILE")->required();
  command->add_option("--lai", c.leaf_area_index, "Leaf area index: one-sided area of leaves over that of ground.")
      ->check(is_positive);
  command->add_option("--count", c.count, "How many leaves, in place of --lai.")->check(CLI::Range(1.0, 4e9));
  command->add_option("--ball", c.ball, "Radius of a ball around 0 that leaves fill, in place of a plot; with --count.")
      ->check(is_positive)
      ->needs("--count");
  std::string names;
  for (const LeafAngles& a : leaf_angle_distributions()) names += (names.empty() ? "" : ", ") + std::string(a.name);
  command->add_option("--angles", o->angles, "Leaf angles: " + names + ".");
  command->add_option("--scale", c.scale, "Of each leaf; the radius where the object is a disk of radius 1.")
      ->check(is_positive);
  command->add_option("--leaf-area", c.leaf_area, "One-sided, of the object at scale 1; pi by default, a disk's.")
      ->check(is_positive);
  command->add_option("--size", c.size, "Of the plot, along x and y, from 0: its period.")
      ->delimiter(',')
      ->check(is_positive);
  command->add_option("--heights", c.heights, "Least and largest height of the leaves' middles.")->delimiter(',');
  command
      ->add_option("--apart", c.apart, "Least distance of leaves' middles; they know nothing of each other by default.")
      ->check(is_positive);
  command
      ->add_option("--column", o->columns,
                   "NAME=LEAST:MOST of a number that each leaf has, for Texture \"instance\"; may be given again.")
      ->allow_extra_args(false);
  command->add_option("--seed", c.seed, "Seed of all random numbers.")->check(is_seed);
  command->add_flag("-q,--quiet", o->quiet, "Print nothing but errors.");
  command->callback([o] { run_canopy(*o); });
}

}  // namespace frond
