#include <cmath>

#include "tests/stability/cases.h"
#include "tests/stability/comparison.h"
#include "tests/support/render_text.h"

namespace frond::stability {
namespace {

using test::channel_mean;
using test::render_text;

const std::string kSky = "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\n";

std::string triple(double x, double y, double z) { return fmt::format("{:.9g} {:.9g} {:.9g}", x, y, z); }

/// A sheet of leaf with its centre at `place`; it fills the film of a camera 30 degrees from its normal.
struct Sheet {
  std::string material;
  std::string world = kSky;
  double half_width = 1, place = 0;
  std::string normals = "";
  std::string more = "";  ///< shapes beside it, in its own coordinates
  std::string integrator = "\"integer maxdepth\" 8";

  std::string text() const {
    const double w = half_width, eye_x = place + 2 * w, eye_z = place + 3 * w;
    return fmt::format(R"(LookAt {} {}  0 1 0
Camera "orthographic" "float screenwindow" [{} {} {} {}]
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
Sampler "independent"
PixelFilter "box"
Integrator "path" {}
WorldBegin
{}Material {}
Translate {}
Rotate 10 1 2 0
{}
Shape "trianglemesh" "point3 P" [{} {} {} {}] "integer indices" [0 1 2  0 2 3] {}
)",
                       triple(eye_x, place, eye_z), triple(place, place, place), -w / 4, w / 4, -w / 4, w / 4,
                       integrator, world, material, triple(place, place, place), more, triple(-w, -w, 0),
                       triple(w, -w, 0), triple(w, w, 0), triple(-w, w, 0), normals);
  }
};

/// Vertex normals tilted by an angle toward +x.
std::string leaning(double deg) {
  return fmt::format("\"normal N\" [{0} {0} {0} {0}]", triple(std::sin(deg * kDegree), 0, std::cos(deg * kDegree)));
}

std::string distant_light(const std::string& from) {
  return fmt::format(
      "LightSource \"distant\" \"point3 from\" [{}] \"point3 to\" [0 0 0] \"spectrum L\" \"stdillum-D65\"\n", from);
}

const std::string kAbm = "\"abm\"", kWeighted = "\"abm\" \"string mode\" \"weighted\"";
const std::string kSimplified = "\"leaf_simplified\" \"string tablemethod\" \"solve\"";

struct Leaf {
  Method method;
  std::string material;
};
const Leaf kLeaves[] = {{Method::path_abm, kAbm},
                        {Method::path_weighted, kWeighted},
                        {Method::path_simplified, kSimplified},
                        {Method::path_solved, "\"leaf_solved\""},
                        {Method::path_lambert, "\"leaf_lambert\""}};

/// Adds a row with the cell cell_of(leaf) for each leaf.
template <class CellOf>
void add_leaves(Theme& theme, std::string name, std::string expected, const CellOf& cell_of) {
  Row& row = theme.add(std::move(name), std::move(expected));
  for (const Leaf& leaf : kLeaves) row.add(leaf.method, cell_of(leaf));
}

Estimate estimate_of(const Film& film, size_t channel) {
  const auto [mean, error] = channel_mean(film, channel);
  return {mean, error * error};
}

constexpr int kSceneSamples = 64;
constexpr int64_t kScenePaths = 64 * kSceneSamples;

Cell furnace(const Leaf& leaf, bool direct) {
  const Sheet sheet{.material = leaf.material + " \"float mesophyllfraction\" 0",
                    .integrator = fmt::format("\"integer maxdepth\" 2 \"bool sampledirect\" {}", direct)};
  const Film film = render_text(sheet.text(), {.samples = kSceneSamples});
  Comparison comparison(2e-4);
  comparison.require(film.not_finite() == 0, "a sample is no number");
  for (size_t c = 0; c < 3; ++c) comparison.add("radiance", estimate_of(film, c), 1, kScenePaths);
  return comparison.cell();
}

/// Shading normals tilted by an angle must not increase the light above the sky's.
Cell bent(const Leaf& leaf, double lean_deg) {
  const Sheet sheet{.material = leaf.material + " \"float mesophyllfraction\" 0", .normals = leaning(lean_deg)};
  const Film film = render_text(sheet.text(), {.samples = kSceneSamples});
  Comparison comparison;
  comparison.require(film.not_finite() == 0, "a sample is no number");
  for (size_t c = 0; c < 3; ++c) {
    const Estimate e = estimate_of(film, c);
    comparison.require(e.mean > 0 && e.mean <= 1 + kMostStandardErrors * e.standard_error() + 10.0 / kScenePaths,
                       fmt::format("the radiance is {:.3g}", e.mean));
  }
  return comparison.cell();
}

Film render_at(const Leaf& leaf, double place) {
  const Sheet sheet{.material = leaf.material,
                    .world = kSky + distant_light(".3 -.4 1"),
                    .half_width = 4096,
                    .place = place,
                    .more = "Shape \"disk\" \"float height\" -512 \"float radius\" 9000\n"};
  return render_text(sheet.text(), {.samples = 4 * kSceneSamples});
}

Cell far_away(const Leaf& leaf, double place) {
  const Film near = render_at(leaf, 0), far = render_at(leaf, place);
  Comparison comparison;
  comparison.require(far.not_finite() == 0, "a sample is no number");
  for (size_t c = 0; c < 3; ++c) {
    const Estimate a = estimate_of(near, c), b = estimate_of(far, c);
    comparison.add("radiance", Estimate{b.mean, a.variance + b.variance}, a.mean, 4 * kScenePaths);
  }
  return comparison.cell();
}

}  // namespace

Theme scenes() {
  Theme theme{
      "Scenes",
      "Means of images of 8 x 8 pixels at 608, 551 and 455 nm. The scene is a tilted sheet of soybean leaf; \"no "
      "absorption\" is a mesophyll fraction of 0. The scenes far from the origin add a second sheet 512 units below "
      "the first and a distant light."};
  for (const bool direct : {false, true})
    add_leaves(theme,
               fmt::format("no absorption, under a sky of radiance 1, {}",
                           direct ? "with light sampling" : "without light sampling"),
               "radiance 1, table within 2e-4", [&](const Leaf& leaf) { return furnace(leaf, direct); });
  for (const double lean_deg : {45.0, 80.0, 89.9, 90.0, 135.0, 180.0})
    add_leaves(
        theme,
        fmt::format("no absorption, under a sky of radiance 1, shading normals tilted by {:g} degrees", lean_deg),
        "radiance above 0, at most 1", [&](const Leaf& leaf) { return bent(leaf, lean_deg); });
  for (const double place : {1e5, 1e7})
    add_leaves(theme, fmt::format("a sheet 8192 units wide, {} units from the origin", rounded_up(place)),
               "as at the origin", [&](const Leaf& leaf) { return far_away(leaf, place); });
  return theme;
}

}  // namespace frond::stability
