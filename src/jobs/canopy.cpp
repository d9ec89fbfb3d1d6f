#include <fmt/format.h>

#include "jobs/record/common_params.h"
#include "scene/geometry/homogeneous_canopy.h"
#include "scene/geometry/instance_writer.h"

namespace frond {

// `frond canopy`: table of randomly placed leaves, a homogeneous canopy in the sense of radiative transfer models.

namespace {

using enum ArgumentKind;

const std::vector<std::string_view> kAngles = [] {
  std::vector<std::string_view> names;
  for (const LeafAngles& a : leaf_angle_distributions()) names.push_back(a.name);
  return names;
}();

/// Lengths in maps that are inverted in 32 bits.
constexpr Interval kLengths{1e-9, 1e9};

const JobParam kParams[] = {
    output_param("Instance table to write, a NumPy file (.npy).", true),
    JobParam("lai", real, "Leaf area index: one-sided leaf area over ground area.",
             {.default_value = "3", .range = kAboveZero}),
    JobParam("count", count, "Number of leaves.", {.range = {1, 4e9}, .excludes = "lai"}),
    JobParam("ball", real, "Fill a ball of this radius around the origin instead of a plot.",
             {.range = kLengths, .needs = "count"}),
    JobParam("angles", text, "Distribution of leaf angles.", {.default_value = "spherical", .choices = kAngles}),
    JobParam("scale", real, "Scale of each leaf: its radius if the object is a disk of radius 1.",
             {.default_value = "0.05", .range = kLengths}),
    JobParam("leaf-area", real, "One-sided area of the object at scale 1; the default is a disk of radius 1.",
             {.default_value = "3.141592653589793", .range = kAboveZero}),
    JobParam("size", numbers, "Size of the plot along x and y, from 0; also the period of a repeated plot.",
             {.type = "X,Y", .default_value = "10,10", .range = kLengths, .values = 2}),
    JobParam("heights", numbers, "Minimum and maximum height of the leaves' centres.",
             {.type = "LEAST,MOST", .default_value = "0,1", .range = {-kLengths.max, kLengths.max}, .values = 2}),
    JobParam("apart", real, "Minimum distance between the leaves' centres; by default positions are independent.",
             {.range = kLengths}),
    JobParam("column", texts,
             "Random number of each leaf for Texture \"instance\", uniform between two bounds: chlorophylla=2:5.",
             {.type = "NAME=LEAST:MOST"}),
    kSeedParam,
};

/// Parses NAME=LEAST:MOST. Throws InputError.
HomogeneousCanopy::Column column_of(const std::string& text, const Arguments& args) {
  const size_t equals = text.find('='), colon = text.find(':', equals == std::string::npos ? 0 : equals);
  std::optional<std::vector<double>> ends;
  if (equals != std::string::npos && colon != std::string::npos)
    ends = parse_numbers(text.substr(equals + 1, colon - equals - 1) + "," + text.substr(colon + 1));
  if (!ends || ends->size() != 2 || !((*ends)[0] <= (*ends)[1]))
    fail({}, "{} takes NAME=LEAST:MOST, as in chlorophylla=2:5; \"{}\" was given", args.spelled("column"), text);
  return {text.substr(0, equals), {(*ends)[0], (*ends)[1]}};
}

/// Returns the canopy of the arguments. Throws InputError if --heights is reversed.
HomogeneousCanopy canopy_of(const Arguments& args) {
  const auto size = args.numbers("size"), heights = args.numbers("heights");
  if (!(heights[0] <= heights[1])) fail({}, "{}: {} is above {}", args.spelled("heights"), heights[0], heights[1]);
  HomogeneousCanopy canopy{.leaf_area_index = args.real("lai"),
                           .count = uint64_t(args.count("count")),
                           .leaf_area = args.real("leaf-area"),
                           .scale = args.real("scale"),
                           .size = {size[0], size[1]},
                           .heights = {heights[0], heights[1]},
                           .ball = args.real("ball"),
                           .apart = args.real("apart"),
                           .seed = args.seed("seed")};
  canopy.angles = &*std::ranges::find(leaf_angle_distributions(), args.text("angles"), &LeafAngles::name);
  for (const std::string& text : args.texts("column")) canopy.columns.push_back(column_of(text, args));
  return canopy;
}

/// The job: draws leaves one by one, so that memory does not grow with their number.
Result canopy(const JobRun& run) {
  const HomogeneousCanopy canopy = canopy_of(run.args);
  const uint64_t leaves = canopy.leaves();
  constexpr uint64_t kMost = 0xfffffffe;  // largest number of instances of one geometry in Embree
  if (leaves == 0)
    fail({},
         "a leaf has the area {:.6g} ({} {:.6g}), the plot {:.6g}: no leaf fits; are both in the same unit, in metres?",
         canopy.leaf_area * canopy.scale * canopy.scale, run.args.spelled("scale"), canopy.scale,
         canopy.size[0] * canopy.size[1]);
  if (leaves > kMost) fail({}, "the number of leaves is {}: {} is the limit", leaves, kMost);
  std::vector<std::string> names;
  for (const HomogeneousCanopy::Column& column : canopy.columns) names.push_back(column.name);
  const std::string output = binary_file_of(run.args, "output");
  InstanceWriter writer(output, leaves, names);
  LeafPlacer placer(canopy);
  std::vector<float> values(names.size());
  for (uint64_t leaf = 0; leaf < leaves; ++leaf) {
    check_stop();
    writer.add(placer.place(values), values);
  }
  writer.finish();
  const double area = double(leaves) * canopy.leaf_area * canopy.scale * canopy.scale;
  Result result{.facts = {{"leaves", double(leaves)}, {"area", area}}};
  std::string message = fmt::format("{}: {} leaves, area {:.6g}", output, leaves, area);
  if (canopy.ball == 0) {
    const double index = area / (canopy.size[0] * canopy.size[1]);
    result.facts.push_back({"leaf_area_index", index});
    message += fmt::format(", leaf area index {:.5g}", index);
  }
  run.log().info(message);
  return result;
}

}  // namespace

extern const JobInfo kCanopyJob("canopy", "Scenes",
                                "Write an instance table of randomly placed leaves, for Shape \"instances\".", "",
                                kParams, SessionUse::none, canopy);

}  // namespace frond
