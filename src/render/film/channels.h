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

/// What channels are made of: what a sample's camera ray met first, and from where.
struct CameraHit {
  const FirstHit& first;
  const Ray& ray;
  Vec3 axis;      ///< of the camera, unit
  Triple albedo;  ///< of the hit, as a colour; 1 where all is given back
};

/// A channel, or up to three, that an image may have beside its colours. A new one is a row of the table in
/// channels.cpp; what it takes and FirstHit has not, the integrator adds there.
struct ChannelInfo {
  /// What becomes of a pixel's samples: the mean of those that met something; what the one nearest to the pixel's
  /// centre says, for ids are no quantities; how many samples there are.
  enum class Kind : uint8_t { mean, nearest, sample_count };
  /// How values follow the space that an image's features are in; points and vectors have three.
  enum class Space : uint8_t { none, point, vector };

  std::string_view name;                ///< as --channels takes it
  std::array<std::string_view, 3> exr;  ///< as the file calls them; empty: there are no more
  Kind kind;
  Space space;
  std::string_view doc;
  Triple (*value)(const CameraHit&);  ///< of one sample; nullptr for sample_count

  constexpr size_t size() const { return exr[1].empty() ? 1 : exr[2].empty() ? 2 : 3; }
};

/// Most values that all channels together can have, by kind.
inline constexpr size_t kMostMeans = 24, kMostIds = 8;

std::span<const ChannelInfo> all_channels();

/// Some channels, each once, in the order of the table.
class ChannelList {
 public:
  ChannelList() = default;
  /// By names; throws InputError that lists them.
  explicit ChannelList(const std::vector<std::string>& names, const Location& where = {});

  const std::vector<const ChannelInfo*>& infos() const { return infos_; }
  std::vector<std::string> names() const;
  bool has(std::string_view name) const;
  /// Values of the channels that are means, and of those that are ids; of all of them together.
  size_t means() const { return means_; }
  size_t ids() const { return ids_; }

 private:
  std::vector<const ChannelInfo*> infos_;
  size_t means_ = 0, ids_ = 0;
};

}  // namespace frond
