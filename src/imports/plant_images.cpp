#include "imports/plant_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "image/image_codec.h"
#include "image/image_signature.h"
#include "imports/obj_lines.h"
#include "imports/uri.h"
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

std::string PlantImages::decoded_name(const std::string& name) const {
  return lower_case(model_.extension().string()) == ".obj" ? name : percent_decoded(name);
}

/// Exporters write absolute paths of their own machine, and Windows' separators; names in glTF are percent-encoded,
/// unless an exporter has forgotten it. A file that is not at the path is searched for by its name in the model's
/// folder and in its subfolder textures.
fs::path PlantImages::find_file(const std::string& name) const {
  const fs::path folder = fs::canonical(model_).parent_path();
  for (std::string text : {name, decoded_name(name)}) {
    std::ranges::replace(text, '\\', '/');
    const fs::path path = text;
    for (const fs::path& candidate : {folder / path, folder / path.filename(), folder / "textures" / path.filename()}) {
      std::error_code error;
      const fs::path file = fs::canonical(candidate, error);
      if (error || !fs::is_regular_file(file, error)) continue;
      if (std::ranges::mismatch(folder, file).in1 == folder.end()) return file;
    }
  }
  fail({}, "there is no such file in the model's folder or below");
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
    std::string name = decoded_name(images_[size_t(image)].name);
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

std::string PlantImages::write_grey_image(int width, int height, std::vector<float> values, const std::string& name) {
  Image out(width, height, {"Y"});
  out.pixels = std::move(values);
  const std::string path = new_path(name, ".png");
  files_.push_back({path, image_codec().encode(path, out, {})});
  return path;
}

}  // namespace frond
