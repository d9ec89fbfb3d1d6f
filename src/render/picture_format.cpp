#include "render/picture_format.h"

#include <algorithm>

#include "core/error.h"
#include "image/spectral_layout.h"
#include "spectra/band_preview.h"
#include "spectra/color_space.h"

namespace frond {
namespace {

const ChannelInfo& info_of(std::string_view name) { return *std::ranges::find(kChannels, name, &ChannelInfo::name); }

/// Values of an image, pixel by pixel, in the order of its channels.
class PixelWriter {
 public:
  PixelWriter(const Film& film, const PictureFormat& format)
      : film_(film), format_(format), largest_(film.settings().largest_value()) {
    if (!format.space.empty()) {
      names_ = {"R", "G", "B", "variance.R", "variance.G", "variance.B", "leaf"};
    } else {
      for (const Band& band : format.bands) names_.push_back(spectral_channel(band.nm));
      for (const Band& band : format.bands) names_.push_back(variance_channel(band.nm));
      names_.emplace_back("leaf");
      preview_ = xyz_of_bands(format.bands);
      if (!preview_.empty()) names_.insert(names_.end(), {"R", "G", "B"});
    }
    for (const std::string& channel : format.channels)
      for (const std::string_view name : info_of(channel).exr)
        if (!name.empty()) names_.emplace_back(name);
  }
  const std::vector<std::string>& names() const { return names_; }

  void write(int x, int y, float* to) {
    to_ = to;
    if (format_.space.empty())
      write_bands(x, y);
    else
      write_colors(x, y);
    const bool has_features = film_.format().features;
    const Film::FeatureMeans means = has_features ? film_.features(x, y) : Film::FeatureMeans{};
    for (const std::string& channel : format_.channels) write_channel(channel, means, film_.samples(x, y));
  }

 private:
  /// Brighter values than the file can hold become its largest, not infinite.
  void put(double value) { *to_++ = float(std::clamp(value, -largest_, largest_)); }
  void put(const Triple& values) {
    for (const double v : values) put(v);
  }

  void write_colors(int x, int y) {
    put(film_.mean(x, y));
    put(film_.variance(x, y));
    put(film_.leaf_fraction(x, y));
  }

  void write_bands(int x, int y) {
    const size_t count = format_.bands.size();
    Triple xyz{};
    float* const variances = to_ + count;
    for (size_t b = 0; b < count; ++b) {
      const Film::BandMean m = film_.band_mean(x, y, b);
      put(m.mean);
      variances[b] = float(std::min(m.variance, largest_));
      for (size_t c = 0; c < 3 && !preview_.empty(); ++c) xyz[c] += preview_[b][c] * m.mean;
    }
    to_ += count;
    put(film_.leaf_fraction(x, y));
    if (!preview_.empty()) put(find_color_space("srgb")->rgb_from_xyz * xyz);
  }

  void write_channel(std::string_view channel, const Film::FeatureMeans& f, uint64_t samples) {
    if (channel == "albedo") put(f.albedo);
    if (channel == "normal") put(mapped(f.normal, 0));
    if (channel == "depth") put(f.depth);
    if (channel == "position") put(mapped(f.position, f.hits > 0 ? 1 : 0));
    if (channel == "material") put(f.hits > 0 ? f.material + 1.0 : 0.0);
    if (channel == "instance") put(double(f.instance));
    if (channel == "samples") put(double(samples));
  }

  /// `w` 1: a point, 0: a vector. Cameras are placed without shear, so that normals are vectors.
  Triple mapped(const Vec3d& v, double w) const {
    Triple result{};
    for (size_t i = 0; i < 3; ++i) {
      const auto& row = format_.from_world[i];
      result[i] = row[0] * v.x + row[1] * v.y + row[2] * v.z + row[3] * w;
    }
    return result;
  }

  const Film& film_;
  const PictureFormat& format_;
  double largest_;
  std::vector<std::string> names_;
  std::vector<Triple> preview_;
  float* to_ = nullptr;
};

}  // namespace

std::vector<std::string> checked_channels(const std::vector<std::string>& names, const Location& where) {
  std::vector<std::string_view> known;
  for (const ChannelInfo& info : kChannels) known.push_back(info.name);
  for (const std::string& name : names)
    if (std::ranges::find(known, name) == known.end())
      fail(where, "there is no channel \"{}\"{}", name, suggestion(name, known));
  std::vector<std::string> result;
  for (const std::string_view name : known)
    if (std::ranges::find(names, name) != names.end()) result.emplace_back(name);
  return result;
}

bool have_features(const std::vector<std::string>& channels) {
  return std::ranges::any_of(channels, [](const std::string& name) { return info_of(name).is_feature; });
}

Image film_image(const Film& film, const PictureFormat& format) {
  PixelWriter writer(film, format);
  const Crop& crop = film.settings().crop;
  Image image(crop.width(), crop.height(), writer.names());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) writer.write(crop.x0 + x, crop.y0 + y, &image.at(x, y, 0));
  return image;
}

}  // namespace frond
