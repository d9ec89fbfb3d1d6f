#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"
#include "core/log.h"
#include "image/rgb_file.h"
#include "instruments/image_error.h"
#include "render/image_output.h"
#include "study/smpte_luminance.h"

namespace frond {
namespace {

constexpr std::string_view kSpace = "linear SMPTE-C";
constexpr std::array<const char*, 3> kChannels{"red", "green", "blue"};

struct DifferenceOptions {
  std::vector<std::string> images;  ///< A1 A2 B1 B2
  std::string output;
  double scale = 0.1;
  bool json = false;
};

float luminance(const Image& image, int x, int y) {
  return smpte_luminance(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
}

/// Signed difference in false colour: blue where `b` is brighter, red where `a` is, white where they agree. The ends
/// are told apart by those who see no red or green as well.
std::array<float, 3> false_color(float t) {
  t = std::clamp(t, -1.f, 1.f);
  const std::array<float, 3> blue{0.13f, 0.40f, 0.67f}, white{0.97f, 0.97f, 0.97f}, red{0.70f, 0.09f, 0.17f};
  const auto& end = t < 0 ? blue : red;
  std::array<float, 3> c{};
  for (size_t k = 0; k < 3; ++k) c[k] = white[k] + (end[k] - white[k]) * std::abs(t);
  return c;
}

void write_difference(const std::string& path, const std::vector<LinearFile>& halves, double scale) {
  const Image& size = halves[0].image;
  Image picture(size.width, size.height, {"R", "G", "B"});
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const auto at = [&](size_t i) { return luminance(halves[i].image, x, y); };
      const auto color = false_color((at(0) + at(1) - at(2) - at(3)) / 2 / float(scale));
      for (size_t c = 0; c < 3; ++c) picture.at(x, y, c) = color[c];
    }
  write_image(path, picture, {"", {{"frond:difference_scale", fmt::format("{}", scale)}}});
}

std::vector<LinearFile> read_halves(const std::vector<std::string>& paths) {
  const ColorManager colors;
  std::vector<LinearFile> halves;
  for (const std::string& path : paths) {
    halves.push_back(read_linear(path));
    check_same_size(halves[0], halves.back());
    colors.convert(halves.back().image.pixels, halves.back().space, kSpace);
  }
  return halves;
}

bool have_the_same_noise(const LinearFile& a, const LinearFile& b) {
  return a.path == b.path || (!a.seed.empty() && a.seed == b.seed);
}

/// Bias is told from noise by (A1 - B1)(A2 - B2): what is on both sides of the product has to be independent. The same
/// seed within one side of it, as in A1 and B1, does no harm.
void warn_of_same_noise(const std::vector<LinearFile>& halves) {
  for (const auto& [i, j] : {std::pair{0u, 1u}, {2u, 3u}, {0u, 3u}, {1u, 2u}})
    if (have_the_same_noise(halves[i], halves[j]))
      ConsoleLog().warn(
          {}, fmt::format("{} and {} have the same seed{}: noise cannot be told from bias; render one of them "
                          "with another --seed",
                          halves[i].path, halves[j].path,
                          halves[i].seed.empty() ? "" : fmt::format(" ({})", halves[i].seed)));
}

/// Adds "rms_red" and so on, with `prefix` before each name.
void add_errors(nlohmann::ordered_json& j, const std::string& prefix, const std::vector<LinearFile>& halves,
                std::span<const float> use) {
  double correlated = 1;
  for (const LinearFile& half : halves) correlated = std::max(correlated, half.correlated_pixels);
  for (size_t c = 0; c < 3; ++c) {
    std::array<std::vector<float>, 4> v;
    for (size_t i = 0; i < 4; ++i) v[i] = halves[i].image.plane(c);
    const ImageError e = image_error(v[0], v[1], v[2], v[3], use, correlated);
    const auto put = [&](const char* name, double value) {
      j[fmt::format("{}{}_{}", prefix, name, kChannels[c])] = value;
    };
    put("rms", e.rms), put("rms_clipped", e.rms_clipped), put("noise", e.noise), put("bias", e.bias());
    put("bias_upper", e.bias_upper()), put("mean_difference", e.mean_difference);
    put("bias_squared", e.bias_squared.value), put("bias_squared_error", e.bias_squared.standard_error);
    put("noise_a", e.noise_a), put("noise_b", e.noise_b);
  }
}

void print_text(const nlohmann::ordered_json& j, const std::string& prefix) {
  fmt::print("{:<18} {:>9} {:>9} {:>9}\n", "", "red", "green", "blue");
  const auto row = [&](const char* title, const char* key) {
    fmt::print("{:<18}", title);
    for (const char* channel : kChannels)
      fmt::print(" {:9.5f}", j[fmt::format("{}{}_{}", prefix, key, channel)].get<double>());
    fmt::print("\n");
  };
  row("RMS", "rms"), row("RMS, clipped", "rms_clipped"), row("noise", "noise"), row("bias", "bias");
  row("bias, upper 95 %", "bias_upper"), row("mean difference", "mean_difference");
}

void difference(const DifferenceOptions& options) {
  if (!options.output.empty()) {
    check_writable(options.output);
    if (is_exr(options.output))
      fail({}, "{}: a difference is a picture in false colour: name a .png or .jpg", options.output);
  }
  const auto halves = read_halves(options.images);
  warn_of_same_noise(halves);
  if (!options.output.empty()) write_difference(options.output, halves, options.scale);
  nlohmann::ordered_json j;
  add_errors(j, "", halves, {});
  const bool knows_leaves = !halves[0].leaf.empty();
  if (knows_leaves) add_errors(j, "leaf_", halves, halves[0].leaf);
  if (options.json) {
    fmt::print("{}\n", j.dump(2));
    return;
  }
  fmt::print("All pixels, linear SMPTE-C\n");
  print_text(j, "");
  if (!knows_leaves) return;
  fmt::print("\nLeaf pixels\n");
  print_text(j, "leaf_");
}

}  // namespace

void add_difference_command(CLI::App& app) {
  auto* command = app.add_subcommand("difference", "RMS error between two renders, with noise and bias told apart.");
  auto o = std::make_shared<DifferenceOptions>();
  command->add_option("images", o->images, "A1 A2 B1 B2: two halves of each render, with seeds of their own.")
      ->type_name("FILE")
      ->required()
      ->expected(4);
  command
      ->add_option("-o,--output", o->output, "Picture of the signed difference in luminance: red where A is brighter.")
      ->type_name("FILE");
  command->add_option("--scale", o->scale, "Difference at full colour; 0.1 by default.")->check(is_positive);
  command->add_flag("--json", o->json, "Print JSON.");
  command->callback([o] { difference(*o); });
}

}  // namespace frond
