#pragma once

#include <filesystem>
#include <string>

#include "render/film/image_format.h"
#include "render/film/statistics.h"
#include "render/parts/identity.h"

namespace frond {

/// What there is to know of a render beside its sums.
struct PartHeader {
  Identity identity;
  ImageFormat image;
  std::string command;   ///< the command line without samples and pixels, which follow from the film
  Crop scene_crop{};     ///< what the scene asks for
  int pixel_scale = 1;   ///< from the film's pixels to the command line's: 2 where --quick has halved them
  uint64_t request = 0;  ///< samples of each pixel that were asked for; adaptive renders may have other numbers
  bool adaptive = false;
  std::vector<uint64_t> tile_ends = {};  ///< of an adaptive render: what it is about to have, by tile
  int round = 0;                         ///< of an adaptive render: how often that was decided
  RenderStatistics statistics = {};
};

/// Some or all of a render: any of its work items, summed up. Two of one identity, which have no sample in common, add
/// up to one; the order does not matter.
struct RenderPart {
  PartHeader header;
  Film film;
};

/// Samples that each pixel has; 0, 0 for a film without pixels.
struct SampleCount {
  uint64_t least = 0, most = 0;
};
SampleCount sample_count(const Film& film);

/// Whether there is a pixel whose samples do not begin at 0, have holes, or, in a render that is not adaptive, end
/// before another's: then what is missing, for people. Else "".
std::string what_is_missing(const RenderPart& part);

/// Whether pixels at the crop's edges lack shared samples of those beside it, which other parts of the image have.
bool lacks_neighbors(const Film& film);

/// Adds parts up; the film's crop is the rectangle around all of theirs. Throws InputError that names the two files and
/// what they have in common, or the field in which they differ.
RenderPart merge_parts(const std::vector<std::filesystem::path>& files);

/// The same with what is written down of it: its command line and its samples.
ImageFormat finished_image(const RenderPart& part);

}  // namespace frond
