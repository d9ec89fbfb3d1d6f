#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/integrator.h"
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
  /// pixel's centre, for ids; number of samples; variance of the samples' colour, and its ratio to the mean.
  enum class Kind : uint8_t { mean, nearest, sample_count, sample_variance, relative_variance };
  /// How values are transformed to camera space (FilmSettings::features_in_camera_space); a point or vector has three.
  enum class Space : uint8_t { none, point, vector };

  std::string_view name;                ///< name for --channels
  std::array<std::string_view, 3> exr;  ///< names of the values in the EXR file; unused ones are empty
  Kind kind;
  Space space;
  std::string_view doc;
  Triple (*value)(const CameraHit&);  ///< value of one sample; nullptr if it is not a property of the hit
  bool is_color = false;              ///< needs a film of colours, not of bands

  /// Number of values.
  constexpr size_t size() const { return exr[1].empty() ? 1 : exr[2].empty() ? 2 : 3; }
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

 private:
  std::vector<const ChannelInfo*> infos_;
  size_t means_ = 0, ids_ = 0;
};

}  // namespace frond
