#pragma once

#include <filesystem>
#include <string>

#include "render/film/adaptive.h"
#include "render/film/image_format.h"
#include "render/film/statistics.h"
#include "render/parts/identity.h"

namespace frond {

/// Header of a part: all data except its film.
struct PartHeader {
  Identity identity;
  ImageFormat image;
  std::string command;   ///< command line without samples and pixels, which follow from the film
  Crop scene_crop{};     ///< crop that the scene states
  int pixel_scale = 1;   ///< pixels of the command line per pixel of the film: 2 with --quick, else 1
  uint64_t request = 0;  ///< requested samples per pixel; adaptive renders can have other numbers
  bool adaptive = false;
  std::vector<uint64_t> tile_ends = {};  ///< adaptive render: samples per pixel of each tile in the current plan
  int round = 0;                         ///< adaptive render: number of noise tests that the film has failed
  RenderStatistics statistics = {};
};

/// Part of a render: the sums over any of its work items. Parts with equal identities and without common samples can be
/// merged in any order.
struct RenderPart {
  PartHeader header;
  Film film;
};

/// Counts the samples of all pixels that the film takes samples of.
SampleCount sample_count(const Film& film);

/// Message about missing samples: a pixel whose samples do not begin at index 0, have gaps, or, unless the render is
/// adaptive, end before those of another pixel. Empty if none are missing.
std::string missing_samples_text(const RenderPart& part);

/// With splatting: true if pixels at the edges of the crop lack contributions of samples next to it, which other parts
/// of the image contain.
bool lacks_neighboring_samples(const Film& film);

/// Merges part files; the film's crop is the bounding rectangle of their crops. Throws an InputError with the two files
/// and the samples that they have in common, or the field of the identity in which they differ.
RenderPart merge_parts(const std::vector<std::filesystem::path>& files);

/// Image format of a part, with the attributes that follow from its film: command line, samples, noise.
ImageFormat finished_format(const RenderPart& part);

}  // namespace frond
