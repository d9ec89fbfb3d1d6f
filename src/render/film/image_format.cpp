#include "render/film/image_format.h"

#include <algorithm>

#include "core/error.h"
#include "image/spectral_layout.h"
#include "spectra/color/color_space.h"
#include "spectra/wavelengths/band_preview.h"

namespace frond {
namespace {

/// Writes the values of an image pixel by pixel, in the order of its channels.
class PixelWriter {
 public:
  PixelWriter(const Film& film, const ImageFormat& format)
      : film_(film), format_(format), largest_(film.settings().largest_value()) {
    if (!format.space.empty()) names_ = {"R", "G", "B", "variance.R", "variance.G", "variance.B", "leaf"};
    for (const Band& band : format.bands) names_.push_back(spectral_channel(band));
    for (const Band& band : format.bands) names_.push_back(variance_channel(band));
    if (format.space.empty()) {
      names_.emplace_back("leaf");
      preview_ = xyz_of_bands(format.bands);
      if (!preview_.empty()) names_.insert(names_.end(), {"R", "G", "B"});
    }
    for (const ChannelInfo* channel : film.format().channels.infos())
      for (std::string& name : channel->exr_names()) names_.push_back(std::move(name));
  }
  const std::vector<std::string>& names() const { return names_; }
  /// Names of the colours, or of the bands and their preview colours.
  std::vector<std::string> image_names() const {
    if (!format_.space.empty()) return {names_.begin(), names_.begin() + 3};
    std::vector<std::string> names(names_.begin(), names_.begin() + ptrdiff_t(format_.bands.size()));
    if (!preview_.empty()) names.insert(names.end(), {"R", "G", "B"});
    return names;
  }

  void write(int x, int y, float* to) {
    to_ = to;
    if (!format_.space.empty()) write_colors(x, y);
    write_bands(x, y);
    write_channels(x, y);
  }
  void write_image(int x, int y, float* to) {
    to_ = to;
    if (!format_.space.empty()) return append(film_.mean(x, y));
    Triple xyz{};
    for (size_t b = 0; b < format_.bands.size(); ++b) {
      const double mean = film_.band(x, y, b);
      append(mean);
      add_band(b, mean, xyz);
    }
    if (!preview_.empty()) append_preview(xyz);
  }

 private:
  /// Clamps values to the largest finite value of the file's format.
  void append(double value) { *to_++ = float(std::clamp(value, -largest_, largest_)); }
  void append(const Triple& values) {
    for (const double v : values) append(v);
  }

  void write_colors(int x, int y) {
    append(film_.mean(x, y));
    append(film_.variance(x, y));
    append(film_.leaf_fraction(x, y));
  }

  void write_bands(int x, int y) {
    const size_t count = format_.bands.size();
    Triple xyz{};
    float* const variances = to_ + count;
    for (size_t b = 0; b < count; ++b) {
      const Film::BandMean m = film_.band_mean(x, y, b);
      append(m.mean);
      variances[b] = float(std::min(m.variance, largest_));
      add_band(b, m.mean, xyz);
    }
    to_ += count;
    if (!format_.space.empty()) return;  // write_colors has written the rest
    append(film_.leaf_fraction(x, y));
    if (!preview_.empty()) append_preview(xyz);
  }

  void add_band(size_t band, double mean, Triple& xyz) const {
    for (size_t c = 0; c < 3 && !preview_.empty(); ++c) xyz[c] += preview_[band][c] * mean;
  }
  void append_preview(const Triple& xyz) { append(find_color_space("srgb")->rgb_from_xyz * xyz); }

  void write_channels(int x, int y) {
    const ChannelList& channels = film_.format().channels;
    const bool has_features = channels.means() + channels.ids() > 0;
    const Film::FeatureMeans features = has_features ? film_.features(x, y) : Film::FeatureMeans{};
    const double* mean = features.means.data();
    const double* id = features.ids.data();
    size_t matte = 0;
    for (const ChannelInfo* channel : channels.infos()) {
      if (channel->is_matte()) {
        append_mattes(channel->kind, film_.mattes(x, y, matte++));
        continue;
      }
      if (!channel->value) {
        append_statistic(channel->kind, x, y);
        continue;
      }
      const double*& value = channel->kind == ChannelInfo::Kind::mean ? mean : id;
      if (channel->space == ChannelInfo::Space::none)
        for (size_t c = 0; c < channel->size(); ++c)
          append(channel->is_share ? std::clamp(value[c], 0.0, 1.0) : value[c]);
      else
        append(to_output_space({value[0], value[1], value[2]},
                               channel->space == ChannelInfo::Space::point && features.hits > 0 ? 1 : 0));
      value += channel->size();
    }
  }

  /// IDs of Cryptomatte are bits, not quantities: they are not clamped.
  void append_mattes(ChannelInfo::Kind kind, const std::vector<Matte>& mattes) {
    if (kind == ChannelInfo::Kind::cryptomatte) {
      to_ = std::ranges::copy(matte_values(mattes, format_.names), to_).out;
      return;
    }
    double alpha = 0;
    for (const Matte& m : mattes) alpha += m.coverage;
    append(std::min(alpha, 1.0));
  }

  void append_statistic(ChannelInfo::Kind kind, int x, int y) {
    const double samples = double(film_.samples(x, y));
    if (kind == ChannelInfo::Kind::sample_count) return append(samples);
    const Triple mean = film_.mean(x, y);
    Triple variance = film_.variance(x, y);
    for (size_t c = 0; c < 3; ++c) {
      variance[c] *= samples;
      if (kind == ChannelInfo::Kind::relative_variance) variance[c] = mean[c] == 0 ? 0 : variance[c] / mean[c];
    }
    append(variance);
  }

  /// Transforms a point (w = 1) or a vector (w = 0). Camera transformations have no shear: normals transform as
  /// vectors.
  Triple to_output_space(const Vec3d& v, double w) const {
    Triple result{};
    for (size_t i = 0; i < 3; ++i) {
      const auto& row = format_.from_world[i];
      result[i] = row[0] * v.x + row[1] * v.y + row[2] * v.z + row[3] * w;
    }
    return result;
  }

  const Film& film_;
  const ImageFormat& format_;
  double largest_;
  std::vector<std::string> names_;
  std::vector<Triple> preview_;
  float* to_ = nullptr;
};

}  // namespace

Image film_image(const Film& film, const ImageFormat& format) {
  PixelWriter writer(film, format);
  const Crop& crop = film.settings().crop;
  Image image(crop.width(), crop.height(), writer.names());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) writer.write(crop.x0 + x, crop.y0 + y, &image.at(x, y, 0));
  return image;
}

Image empty_image(const Film& film, const ImageFormat& format) {
  const Crop& crop = film.settings().crop;
  return {crop.width(), crop.height(), PixelWriter(film, format).image_names()};
}

bool update_image(const Film& film, const ImageFormat& format, const std::stop_token& stop, Image& image) {
  PixelWriter writer(film, format);
  const Crop& crop = film.settings().crop;
  for (size_t i = 0; i < film.tiles(); ++i) {
    if (stop.stop_requested()) return false;
    const Crop pixels = intersection(film.tile_pixels(i), crop);
    if (pixels.width() <= 0 || pixels.height() <= 0) continue;  // a tile outside the image, needed for splatting
    const Film::Hold hold = film.hold(pixels);
    for (int y = pixels.y0; y < pixels.y1; ++y)
      for (int x = pixels.x0; x < pixels.x1; ++x) writer.write_image(x, y, &image.at(x - crop.x0, y - crop.y0, 0));
  }
  return true;
}

}  // namespace frond
