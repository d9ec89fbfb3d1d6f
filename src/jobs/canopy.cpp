#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "jobs/record/common_params.h"
#include "jobs/support/canopy_files.h"
#include "scene/geometry/instance_writer.h"

namespace frond {

// `frond canopy`: table of randomly placed leaves in a layer, by a profile of leaf area density, in crowns or in rows.

namespace {

using enum ArgumentKind;

/// Of maps that are inverted in 32 bits.
constexpr Interval kLengths{1e-9, 1e9};

const JobParam kCanopyParams[] = {
    output_param("Instance table to write, a NumPy file (.npy).", true),
    JobParam("lai", real, "Leaf area index: one-sided leaf area over ground area.",
             {.default_value = "3", .range = kAboveZero}),
    JobParam("count", count, "Number of leaves.", {.range = {1, 4e9}, .excludes = "lai"}),
    JobParam("ball", real, "Fill a ball of this radius around the origin instead of a plot.",
             {.range = kLengths, .needs = "count"}),
    JobParam("angles", text,
             "Distribution of leaf angles: spherical, planophile, erectophile, plagiophile, extremophile, uniform, "
             "horizontal; ellipsoidal,mean=57.3 (degrees) or ellipsoidal,chi=1; beta,mu=2.77,nu=1.17; or a CSV file of "
             "angle (degrees) and frequency.",
             {.type = "ANGLES", .default_value = "spherical"}),
    JobParam("scale", real, "Scale of each leaf: its radius if the object is a disk of radius 1.",
             {.default_value = "0.05", .range = kLengths}),
    JobParam("leaf-area", real, "One-sided area of the object at scale 1; the default is a disk of radius 1.",
             {.default_value = "3.141592653589793", .range = kAboveZero}),
    JobParam("size", numbers, "Size of the plot along x and y, from 0; also the period of a repeated plot.",
             {.type = "X,Y", .default_value = "10,10", .range = kLengths, .values = 2}),
    JobParam("heights", numbers, "Minimum and maximum height of the leaves' centres.",
             {.type = "LEAST,MOST", .default_value = "0,1", .range = {-kLengths.max, kLengths.max}, .values = 2}),
    JobParam("profile", text,
             "CSV file of height and leaf area density (m2/m3), linear between its rows. Its integral is the leaf area "
             "index unless --lai or --count is given.",
             {.type = "FILE", .path = PathUse::read, .excludes = "heights,ball,crowns"}),
    JobParam("rows", numbers,
             "Rows of this spacing and width along y, the first half a spacing from x = 0. The leaf area index is that "
             "of the plot.",
             {.type = "SPACING,WIDTH", .range = kLengths, .values = 2, .excludes = "ball,crowns"}),
    JobParam("crowns", text,
             "CSV file of crowns that hold the leaves, one in each line: x, y, z of its middle, or base in place of z; "
             "radius, or rx, ry, rz; optional: shape (ellipsoid, cone, cylinder), density relative to other crowns.",
             {.type = "FILE", .path = PathUse::read, .excludes = "heights,ball"}),
    JobParam("apart", real, "Minimum distance between the leaves' centres; by default positions are independent.",
             {.range = kLengths}),
    JobParam("column", texts,
             "Random number of each leaf for Texture \"instance\", uniform between two bounds: chlorophylla=2:5.",
             {.type = "NAME=LEAST:MOST"}),
    kSeedParam,
};

/// Parses NAME=LEAST:MOST. Throws InputError.
RandomCanopy::Column column_of(const std::string& text, const Arguments& args) {
  const size_t equals = text.find('='), colon = text.find(':', equals == std::string::npos ? 0 : equals);
  std::optional<std::vector<double>> ends;
  if (equals != std::string::npos && colon != std::string::npos)
    ends = parse_numbers(text.substr(equals + 1, colon - equals - 1) + "," + text.substr(colon + 1));
  if (!ends || ends->size() != 2 || !((*ends)[0] <= (*ends)[1]))
    fail({}, "{} takes NAME=LEAST:MOST, as in chlorophylla=2:5; \"{}\" was given", args.spelled("column"), text);
  return {text.substr(0, equals), {(*ends)[0], (*ends)[1]}};
}

/// Returns --rows. Throws InputError for rows that overlap or do not fit into the plot; warns if a repeated plot would
/// have another distance between its last row and the next.
std::optional<PlantRows> rows_of(const JobRun& run, double size) {
  const auto v = run.args.numbers("rows");
  if (v.empty()) return {};
  const std::string option = run.args.spelled("rows");
  if (v[1] > v[0]) fail({}, "{}: the width {:g} is larger than the spacing {:g}", option, v[1], v[0]);
  if (v[0] > size) fail({}, "{}: the plot is {:g} wide, no row of spacing {:g} fits", option, size, v[0]);
  constexpr double kRounding = 1e-6;  // of the number of rows, which decimal fractions as 10 / 0.1 leave
  if (const double count = size / v[0]; std::abs(count - std::round(count)) > kRounding)
    run.log().warn({},
                   fmt::format("{}: the plot's width {:g} is no multiple of the spacing {:g}: repeated, its rows are "
                               "not evenly spaced",
                               option, size, v[0]));
  return PlantRows{v[0], v[1]};
}

/// Warns if the crowns' centres extend over more than the plot, whose area is that of the leaf area index.
void check_plot(const JobRun& run, const RandomCanopy& canopy) {
  const auto [west, east] = std::ranges::minmax(canopy.crowns, {}, [](const Crown& c) { return c.centre.x; });
  const auto [south, north] = std::ranges::minmax(canopy.crowns, {}, [](const Crown& c) { return c.centre.y; });
  const double along_x = east.centre.x - west.centre.x, along_y = north.centre.y - south.centre.y;
  if (along_x <= canopy.size[0] && along_y <= canopy.size[1]) return;
  run.log().warn({}, fmt::format("{}: the crowns' centres extend over {:g} x {:g}, the plot ({}) is {:g} x {:g}: leaf "
                                 "area index and period are those of the plot",
                                 run.args.spelled("crowns"), along_x, along_y, run.args.spelled("size"), canopy.size[0],
                                 canopy.size[1]));
}

/// Returns the canopy of the arguments, whose distribution is `angles`. Throws InputError if --heights is reversed.
RandomCanopy canopy_of(const JobRun& run, const LeafAngles& angles) {
  const Arguments& args = run.args;
  const auto size = args.numbers("size"), heights = args.numbers("heights");
  if (!(heights[0] <= heights[1])) fail({}, "{}: {} is above {}", args.spelled("heights"), heights[0], heights[1]);
  RandomCanopy canopy{.leaf_area_index = args.real("lai"),
                      .count = uint64_t(args.count("count")),
                      .angles = &angles,
                      .leaf_area = args.real("leaf-area"),
                      .scale = args.real("scale"),
                      .size = {size[0], size[1]},
                      .heights = {heights[0], heights[1]},
                      .ball = args.real("ball"),
                      .rows = rows_of(run, size[0]),
                      .apart = args.real("apart"),
                      .seed = args.seed("seed")};
  // A profile states its own leaf area; --lai scales it.
  if (args.given("profile")) {
    canopy.profile = read_profile(args.text("profile"));
    if (!args.given("lai")) canopy.leaf_area_index = canopy.profile->integral();
  }
  if (args.given("crowns")) {
    canopy.crowns = read_crowns(args.text("crowns"));
    check_plot(run, canopy);
  }
  for (const std::string& text : args.texts("column")) canopy.columns.push_back(column_of(text, args));
  return canopy;
}

/// Returns the distribution as text with its mean: "spherical, mean 57.30 degrees".
std::string text_of(const LeafAngles& angles) {
  const double mean = angles.mean() * 180 / std::numbers::pi;
  return fmt::format("{}{}, mean {:.2f} degrees", angles.name,
                     angles.chi ? fmt::format(", chi {:.5g}", *angles.chi) : "", mean);
}

/// The job: draws leaves one by one, so that memory does not grow with their number.
Result canopy(const JobRun& run) {
  const LeafAngles angles = leaf_angles_of(run.args.text("angles"), run.args.spelled("angles"));
  const RandomCanopy canopy = canopy_of(run, angles);
  const uint64_t leaves = canopy.leaves();
  constexpr uint64_t kMost = 0xfffffffe;  // largest number of instances of one geometry in Embree
  if (leaves == 0)
    fail({},
         "a leaf has the area {:.6g} ({} {:.6g}), the plot {:.6g}: no leaf fits; are both in the same unit, in metres?",
         canopy.leaf_area * canopy.scale * canopy.scale, run.args.spelled("scale"), canopy.scale,
         canopy.size[0] * canopy.size[1]);
  if (leaves > kMost) fail({}, "the number of leaves is {}: {} is the limit", leaves, kMost);
  std::vector<std::string> names;
  for (const RandomCanopy::Column& column : canopy.columns) names.push_back(column.name);
  const std::string output = binary_file_of(run.args, "output");
  const MapType type = map_type(canopy.largest_position());
  InstanceWriter writer(output, leaves, names, type);
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
  message += fmt::format("; leaf angles {}", text_of(angles));
  if (type == MapType::precise) message += "; 64-bit floats for positions far from the origin";
  result.facts.push_back({"mean_leaf_angle_deg", angles.mean() * 180 / std::numbers::pi});
  if (angles.chi) result.facts.push_back({"chi", *angles.chi});
  run.log().info(message);
  return result;
}

}  // namespace

extern const JobInfo kCanopyJob("canopy", "Scenes",
                                "Write an instance table of randomly placed leaves, for Shape \"instances\".", "",
                                kCanopyParams, SessionUse::none, canopy);

}  // namespace frond
