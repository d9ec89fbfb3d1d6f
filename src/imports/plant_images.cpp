#include "imports/plant_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/math/vec.h"
#include "core/parallel.h"
#include "image/image_codec.h"
#include "image/image_signature.h"
#include "imports/file_in.h"
#include "system/file_bytes.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Returns the extension that selects the encoding of a format's values in a scene.
std::string extension_of(std::string_view format) {
  if (format == "openexr") return "exr";
  if (format == "jpeg") return "jpg";
  if (format == "pnm") return "pfm";
  if (format == "targa") return "tga";
  if (format == "tiff") return "tif";
  return std::string(format);
}

float to_srgb(float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }

}  // namespace

float to_linear(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

std::string plain_name(std::string_view name) {
  constexpr size_t kLongest = 60;
  std::string out;
  for (const char c : name.substr(0, kLongest)) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    out += is_plain ? c : '_';
  }
  return out.empty() ? "unnamed" : out;
}

PlantImages::PlantImages(const std::vector<ImportedImage>& images, const fs::path& model,
                         const std::vector<std::string>& folders, std::string subfolder, const Log& log)
    : images_(images), model_(model), subfolder_(std::move(subfolder)), log_(log) {
  for (const std::string& folder : folders) {
    std::error_code error;
    folders_.push_back(fs::canonical(folder, error));
    if (error || !fs::is_directory(folders_.back())) fail({}, "there is no folder \"{}\"", folder);
  }
}

/// Exporters write absolute paths of their own machine. A file that is not at its path is searched for by its name in
/// the model's folder and in its subfolder textures, and in the folders that the user names.
fs::path PlantImages::find_file(std::string name) const {
  std::ranges::replace(name, '\\', '/');
  const fs::path path = name;
  const auto found = [](const fs::path& folder, const fs::path& file) {
    try {
      return file_in(folder, file.string());
    } catch (const std::runtime_error&) {
      return fs::path();
    }
  };
  const fs::path own = fs::canonical(model_).parent_path();
  for (const fs::path& file : {path, path.filename(), "textures" / path.filename()})
    if (fs::path result = found(own, file); !result.empty()) return result;
  for (const fs::path& folder : folders_)
    if (fs::path result = found(folder, path.filename()); !result.empty()) return result;
  fail({}, "there is no such file in the model's folder or below, or in a folder that the option textures names");
}

/// Everything that can be wrong with an image is a warning: the material keeps its colour.
PlantImages::Decoded* PlantImages::decoded(int32_t image) {
  const auto [entry, is_new] = decoded_.try_emplace(image);
  if (!is_new) return entry->second.get();
  const ImportedImage& source = images_.at(size_t(image));
  try {
    auto result = std::make_unique<Decoded>();
    if (source.bytes.empty()) {
      inputs_.push_back(find_file(source.name));
      const std::string bytes = read_file_bytes(inputs_.back(), {}, "image");
      result->bytes.assign(bytes.begin(), bytes.end());
    } else {
      result->bytes = source.bytes;
    }
    const std::string_view bytes{reinterpret_cast<const char*>(result->bytes.data()), result->bytes.size()};
    const fs::path name = source.name + (source.extension.empty() ? "" : "." + source.extension);
    const std::string_view format = image_format_of(bytes, name, {});
    result->file = image_codec().decode(bytes, format, name, {});
    for (const std::string& message : result->file.left_out) log_.warn({}, message);
    const size_t channels = result->file.image.channels.size();
    if (channels < 1 || channels > 4) fail({}, "it has {} channels", channels);
    result->path = "." + extension_of(format);  // until it is used
    entry->second = std::move(result);
  } catch (const InputError& error) {
    log_.warn({}, fmt::format("image \"{}\" is left out: {}", source.name, error.what()));
  }
  return entry->second.get();
}

const ImageFile* PlantImages::pixels(int32_t image) {
  const Decoded* result = image < 0 ? nullptr : decoded(image);
  return result ? &result->file : nullptr;
}

std::string PlantImages::new_path(const std::string& name, const std::string& extension) {
  const auto is_taken = [this](const std::string& path) {
    return std::ranges::find(files_, path, &PlantFile::path) != files_.end();
  };
  const std::string base = subfolder_ + "/" + plain_name(name);
  std::string path = base + extension;
  for (int i = 2; is_taken(path); ++i) path = fmt::format("{}-{}{}", base, i, extension);
  return path;
}

std::string PlantImages::original(int32_t image) {
  Decoded& result = *decoded(image);
  if (result.path.starts_with('.')) {
    std::string name = images_[size_t(image)].name;
    std::ranges::replace(name, '\\', '/');
    result.path = new_path(fs::path(name).stem().string(), result.path);
    files_.push_back({result.path, result.bytes});
  }
  return result.path;
}

std::string PlantImages::tinted_image(int32_t image, const std::array<float, 3>& factor, const std::string& name) {
  std::string& path = tinted_[{image, factor}];
  if (!path.empty()) return path;
  const ImageFile& source = decoded(image)->file;
  const size_t channels = source.image.channels.size();
  Image out(source.image.width, source.image.height, {"R", "G", "B"});
  for (int y = 0; y < out.height; ++y) {
    check_stop();
    for (int x = 0; x < out.width; ++x)
      for (size_t c = 0; c < 3; ++c) {
        const float v = source.image.at(x, y, channels < 3 ? 0 : c);
        out.at(x, y, c) = to_srgb(std::clamp((source.is_encoded ? to_linear(v) : v) * factor[c], 0.f, 1.f));
      }
  }
  path = new_path(name, ".png");
  files_.push_back({path, image_codec().encode(path, out, {})});
  return path;
}

std::string PlantImages::normal_image(int32_t image, const std::array<float, 2>& scale, const std::string& name) {
  const Image& source = decoded(image)->file.image;
  if (scale == std::array<float, 2>{1, 1} || source.channels.size() < 3) return original(image);
  std::string& path = tinted_[{image, {scale[0], scale[1], -1}}];
  if (!path.empty()) return path;
  Image out(source.width, source.height, {"R", "G", "B"});
  for (int y = 0; y < out.height; ++y) {
    check_stop();
    for (int x = 0; x < out.width; ++x) {
      const auto value = [&](size_t c) { return 2 * source.at(x, y, c) - 1; };
      const Vec3 n{value(0) * scale[0], value(1) * scale[1], value(2)};
      const float size = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z), 1.f});  // the length has no effect
      for (size_t c = 0; c < 3; ++c) out.at(x, y, c) = (c == 0 ? n.x : c == 1 ? n.y : n.z) / size / 2 + 0.5f;
    }
  }
  path = new_path(name, ".png");
  files_.push_back({path, image_codec().encode(path, out, {})});
  return path;
}

std::string PlantImages::write_grey_image(int width, int height, std::vector<float> values, const std::string& name) {
  Image out(width, height, {"Y"});
  out.pixels = std::move(values);
  const std::string path = new_path(name, ".png");
  files_.push_back({path, image_codec().encode(path, out, {})});
  return path;
}

}  // namespace frond
