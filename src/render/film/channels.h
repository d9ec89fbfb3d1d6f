#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/integrator.h"
#include "render/film/mattes.h"
#include "spectra/matrix3.h"

namespace frond {

/// Input of a channel: the first hit of a sample's camera ray.
struct CameraHit {
  const FirstHit& first;
  const Ray& ray;  ///< the camera ray
  Vec3 axis;       ///< viewing direction of the camera, unit
  Triple albedo;   ///< albedo of the hit as a colour; 1 for a surface without absorption
};

/// Additional channel of an image, of one to three values. A new channel is a row of the table in channels.cpp; if it
/// needs data that FirstHit lacks, the integrator must provide them there.
struct ChannelInfo {
  /// How a pixel's value follows from its samples: mean over the samples with a hit; value of the sample nearest to the
  /// pixel's centre, for ids; number of samples; variance of the samples' colour, and its ratio to the mean; share of
  /// the pixel that surfaces cover; the same by surface (cryptomatte.h). The last two have the filter's weights.
  enum class Kind : uint8_t { mean, nearest, sample_count, sample_variance, relative_variance, coverage, cryptomatte };
  /// How values are transformed to camera space (FilmSettings::features_in_camera_space); a point or vector has three.
  enum class Space : uint8_t { none, point, vector };

  std::string_view name;                ///< name for --channels
  std::array<std::string_view, 3> exr;  ///< names of the values in the EXR file, or of the layer; unused ones are empty
  Kind kind;
  Space space;
  std::string_view doc;
  /// Value of one sample, or its MatteKey; nullptr if it is not a property of the hit.
  Triple (*value)(const CameraHit&);
  bool is_color = false;  ///< needs a film of colours, not of bands
  /// Values lie between 0 and 1. Estimates from few wavelengths can lie outside: images have the nearest such value.
  bool is_share = false;

  /// Number of values.
  constexpr size_t size() const { return exr[1].empty() ? 1 : exr[2].empty() ? 2 : 3; }
  /// Whether the film keeps a MatteList of it.
  constexpr bool is_matte() const { return kind == Kind::coverage || kind == Kind::cryptomatte; }
  /// Names of all its channels in the EXR file.
  std::vector<std::string> exr_names() const;
};

/// Upper limits of the number of values of all channels of kind mean, and of kind nearest.
inline constexpr size_t kMostMeans = 24, kMostIds = 8;

/// Table of all channels.
std::span<const ChannelInfo> all_channels();

/// Selection of channels, without duplicates, in the order of the table.
class ChannelList {
 public:
  ChannelList() = default;
  /// Channels with these names. Throws an InputError that lists the known names.
  explicit ChannelList(const std::vector<std::string>& names, const Location& where = {});

  const std::vector<const ChannelInfo*>& infos() const { return infos_; }
  std::vector<std::string> names() const;
  bool has(std::string_view name) const;
  /// True if a channel has the albedo of the hit.
  bool has_albedo() const { return has("albedo") || has("Albedo"); }
  /// Name of a channel that needs a film of colours, not of bands; empty if there is none.
  std::string_view color() const;
  /// Total number of values of the channels of kind mean, and of kind nearest.
  size_t means() const { return means_; }
  size_t ids() const { return ids_; }
  /// Number of channels with mattes.
  size_t mattes() const { return mattes_; }
  /// Keys of a hit in their lists.
  std::array<MatteKey, kMostMattes> matte_keys(const CameraHit& hit) const;

 private:
  std::vector<const ChannelInfo*> infos_;
  size_t means_ = 0, ids_ = 0, mattes_ = 0;
};

}  // namespace frond
