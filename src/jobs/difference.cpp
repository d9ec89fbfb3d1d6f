#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/not_finite.h"
#include "image/rgb_file.h"
#include "instruments/errors/image_error.h"
#include "jobs/record/common_params.h"
#include "spectra/color/color_management.h"
#include "study/smpte_luminance.h"

namespace frond {

// `frond difference`: RMS error between two renders. Two halves of each render separate noise from bias.

namespace {

using enum ArgumentKind;

constexpr std::string_view kSpace = "linear SMPTE-C";
constexpr size_t kColors = 3;
/// The last one is all colour values together: its mean squares are the means of the three.
constexpr std::array<const char*, kColors + 1> kChannels{"red", "green", "blue", "all"};
constexpr JobParam kDifferenceParams[] = {
    files_param("images", "A1 A2 B1 B2: two halves of render A and two of render B, each with its own seed.", 4),
    output_param("Image of the signed difference in luminance: red where A is brighter, blue where B is.", false),
    JobParam("scale", real, "Luminance difference that is drawn in full colour.",
             {.default_value = "0.1", .range = kAboveZero}),
    kJsonParam,
};

/// Colour of a difference: blue below 0 (`b` is brighter), red above, white at 0. The palette is safe for colour
/// blindness.
std::array<float, 3> false_color(float t) {
  t = std::clamp(t, -1.f, 1.f);
  const std::array<float, 3> blue{0.13f, 0.40f, 0.67f}, white{0.97f, 0.97f, 0.97f}, red{0.70f, 0.09f, 0.17f};
  const auto& end = t < 0 ? blue : red;
  std::array<float, 3> c{};
  if (std::isnan(t)) return c;  // black: a value is not finite
  for (size_t k = 0; k < 3; ++k) c[k] = white[k] + (end[k] - white[k]) * std::abs(t);
  return c;
}

/// Writes the difference of mean luminances, A minus B, in false colour.
void write_difference(const std::string& path, const std::vector<LinearFile>& halves, double scale) {
  const Image& size = halves[0].image;
  Image shown(size.width, size.height, {"R", "G", "B"});
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const auto at = [&](size_t i) {
        const Image& image = halves[i].image;
        return smpte_luminance(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
      };
      const bool is_finite =
          std::ranges::all_of(std::array{0, 1, 2, 3}, [&](size_t i) { return std::isfinite(at(i)); });
      const auto color = false_color(!is_finite ? NAN : (at(0) + at(1) - at(2) - at(3)) / 2 / float(scale));
      for (size_t c = 0; c < 3; ++c) shown.at(x, y, c) = color[c];
    }
  write_image(path, shown, {"", {{"frond:difference_scale", fmt::format("{}", scale)}}});
}

/// Reads the four images and converts them to linear SMPTE-C, in which errors are measured.
std::vector<LinearFile> read_halves(const std::vector<std::string>& paths, const Log& log) {
  const ColorManager colors;
  std::vector<LinearFile> halves;
  for (const std::string& path : paths) {
    halves.push_back(read_linear(path));
    check_same_size(halves[0], halves.back());
    for (const std::string& message : halves.back().left_out) log.warn({}, message);
    if (const std::string text = not_finite_text(halves.back().image); !text.empty())
      log.warn({}, fmt::format("{} holds {}: errors over these pixels are not known", path, text));
    colors.convert(halves.back().image.pixels, halves.back().space, kSpace);
  }
  return halves;
}

/// The bias estimate is the mean of (A1 - B1)(A2 - B2), so the two factors must be independent. A common seed within
/// one factor, as in A1 and B1, is harmless.
void warn_of_same_noise(const std::vector<LinearFile>& halves, const Log& log) {
  if (halves[0].path == halves[2].path && halves[1].path == halves[3].path)
    log.warn({}, "A and B are the same images: their difference is 0");
  for (const auto& [i, j] : {std::pair{0u, 1u}, {2u, 3u}, {0u, 3u}, {1u, 2u}}) {
    const LinearFile &a = halves[i], &b = halves[j];
    if (a.path != b.path && (a.seed.empty() || a.seed != b.seed)) continue;
    log.warn({}, fmt::format("{} and {} have the same seed{}: noise cannot be told from bias; render one of them with "
                             "another --seed",
                             a.path, b.path, a.seed.empty() ? "" : fmt::format(" ({})", a.seed)));
  }
}

/// Statistics of a channel, in the order of the table and the facts. Text output shows those with a title.
constexpr struct {
  const char *name, *title;
  double (*value)(const ImageError&);
} kNumbers[] = {
    {"rms", "RMS", [](const ImageError& e) { return e.rms; }},
    {"rms_clipped", "RMS, clipped", [](const ImageError& e) { return e.rms_clipped; }},
    {"noise", "noise", [](const ImageError& e) { return e.noise; }},
    {"bias", "bias", [](const ImageError& e) { return e.bias(); }},
    {"bias_upper", "bias, upper 95 %", [](const ImageError& e) { return e.bias_upper(); }},
    {"mean_difference", "mean difference", [](const ImageError& e) { return e.mean_difference; }},
    {"bias_squared", "", [](const ImageError& e) { return e.bias_squared.value; }},
    {"bias_squared_error", "", [](const ImageError& e) { return e.bias_squared.standard_error; }},
    {"noise_a", "", [](const ImageError& e) { return e.noise_a; }},
    {"noise_b", "", [](const ImageError& e) { return e.noise_b; }},
};

/// Adds facts ("rms_red", with `prefix` before the name) and table rows for the pixels selected by `use`. Returns the
/// text.
std::string add_errors(Result& result, const std::string& region, const std::string& prefix,
                       const std::vector<LinearFile>& halves, std::span<const float> use) {
  double correlated = 1;
  for (const LinearFile& half : halves) correlated = std::max(correlated, half.correlated_pixels);
  std::array<ImageError, kChannels.size()> errors;
  std::array<std::vector<float>, 4> all;
  std::vector<float> all_use;
  for (size_t c = 0; c < kChannels.size(); ++c) {
    if (c < kColors) {
      std::array<std::vector<float>, 4> v;
      for (size_t i = 0; i < 4; ++i) {
        v[i] = halves[i].image.plane(c);
        all[i].insert(all[i].end(), v[i].begin(), v[i].end());
      }
      all_use.insert(all_use.end(), use.begin(), use.end());
      errors[c] = image_error(v[0], v[1], v[2], v[3], use, correlated);
    } else {
      // The colours of a pixel share its noise.
      errors[c] = image_error(all[0], all[1], all[2], all[3], all_use, correlated * double(kColors));
    }
    result.tables[0].add("region", region);
    result.tables[0].add("channel", std::string(kChannels[c]));
    for (const auto& n : kNumbers) {
      result.tables[0].add(n.name, n.value(errors[c]));
      result.facts.push_back({fmt::format("{}{}_{}", prefix, n.name, kChannels[c]), n.value(errors[c])});
    }
  }
  Table shown;
  for (const auto& n : kNumbers) {
    if (*n.title == '\0') continue;
    shown.add(region + " pixels", std::string(n.title));
    for (size_t c = 0; c < kChannels.size(); ++c) shown.add(kChannels[c], n.value(errors[c]));
  }
  for (Column& column : shown.columns) column.missing = "not known";
  return to_text(shown);
}

/// The job: prints errors over all pixels, and over leaf pixels if the image has a leaf mask.
Result difference(const JobRun& run) {
  warn_if_nothing_is_kept(run);
  const std::string output = run.args.text("output");
  if (!output.empty()) check_writable(output);
  if (!output.empty() && is_exr(output))
    fail({}, "{}: a difference is an image in false colour: name a .png or .jpg", output);
  const auto halves = read_halves(run.args.texts("images"), run.log());
  warn_of_same_noise(halves, run.log());
  if (!output.empty()) write_difference(output, halves, run.args.real("scale"));
  Result result{.tables = {{"difference"}}};
  result.text = fmt::format("In {}\n{}", kSpace, add_errors(result, "all", "", halves, {}));
  if (!halves[0].leaf.empty()) result.text += '\n' + add_errors(result, "leaf", "leaf_", halves, halves[0].leaf);
  if (run.args.given("json")) result.json = to_json({}, result.facts, {});
  return result;
}

}  // namespace

extern const JobInfo kDifferenceJob("difference", "Images",
                                    "Measure the RMS error between two renders, with noise and bias separated.", "",
                                    kDifferenceParams, SessionUse::none, difference);

}  // namespace frond
