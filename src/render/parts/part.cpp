#include "render/parts/part.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "core/error.h"
#include "render/film/adaptive.h"
#include "render/parts/part_file.h"

namespace frond {
namespace {

std::string text_of(const Crop& c) { return fmt::format("{},{},{},{}", c.x0, c.x1, c.y0, c.y1); }

Crop scaled(const Crop& c, int scale) { return {c.x0 * scale, c.y0 * scale, c.x1 * scale, c.y1 * scale}; }

Crop bounding_rectangle(const Crop& a, const Crop& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

template <class Each>
void for_each_pixel(const Crop& c, const Each& each) {
  for (int y = c.y0; y < c.y1; ++y)
    for (int x = c.x0; x < c.x1; ++x) each(x, y);
}

/// Samples that two tiles have in common.
std::optional<WorkItem> common(const FilmTile& a, const FilmTile& b) {
  for (const WorkItem& i : a.coverage().items())
    for (const WorkItem& j : b.coverage().items())
      if (const WorkItem both = intersection(i, j); !both.empty()) return both;
  return {};
}

std::string text_of(const WorkItem& item) {
  return fmt::format("samples {}:{} of pixels {}", item.samples.begin, item.samples.end, text_of(item.pixels));
}

bool contains(const Crop& c, int x, int y) { return x >= c.x0 && x < c.x1 && y >= c.y0 && y < c.y1; }

/// Throws an InputError with the file at index `last`, an earlier file, and the samples that they have in common.
[[noreturn]] void fail_with_overlap(const std::vector<std::filesystem::path>& files, size_t last) {
  const Film b = read_part(files[last]).film;
  for (size_t i = 0; i < last; ++i) {
    const Film a = read_part(files[i]).film;
    for (size_t t = 0; t < b.tiles(); ++t) {
      const Crop c = b.tile_pixels(t);
      for (const auto& [x, y] : {std::pair{c.x0, c.y0}, {c.x1 - 1, c.y0}, {c.x0, c.y1 - 1}, {c.x1 - 1, c.y1 - 1}}) {
        if (!contains(a.sampled(), x, y)) continue;
        if (const auto item = common(a.tile(a.tile_at(x, y)), b.tile(t)))
          fail({}, "\"{}\" and \"{}\" both have {}: each sample counts once", files[i].string(), files[last].string(),
               text_of(*item));
      }
    }
  }
  fail({}, "\"{}\" changed while it was read", files[last].string());
}

}  // namespace

SampleCount sample_count(const Film& film) {
  SampleCount count{std::numeric_limits<uint64_t>::max(), 0};
  for_each_pixel(film.sampled(), [&](int x, int y) {
    const uint64_t n = film.samples(x, y);
    count = {std::min(count.least, n), std::max(count.most, n)};
  });
  return count;
}

std::string missing_samples_text(const RenderPart& part) {
  const uint64_t most = sample_count(part.film).most;
  std::string beside;  // missing samples of pixels outside of the image, with splatting
  for (size_t i = 0; i < part.film.tiles(); ++i) {
    const FilmTile& tile = part.film.tile(i);
    uint64_t end = part.header.adaptive ? 0 : most;
    for (const WorkItem& item : tile.coverage().items()) end = std::max(end, item.samples.end);
    for (const WorkItem& item : tile.coverage().missing({tile.pixels(), {0, std::max<uint64_t>(end, 1)}})) {
      const WorkItem inside{intersection(item.pixels, part.film.settings().crop), item.samples};
      if (!inside.empty()) return text_of(inside);
      if (beside.empty()) beside = text_of(item);
    }
  }
  return beside;
}

bool lacks_neighboring_samples(const Film& film) {
  const auto& s = film.format().splatting;
  return s && s->sampled != widened(film.settings().crop, s->reach_x(), s->reach_y());
}

RenderPart merge_parts(const std::vector<std::filesystem::path>& files) {
  // All headers first, so that parts that do not match are reported early. Then one whole part at a time.
  const PartHead first = read_part_head(files.front());
  PartHeader header = first.header;
  header.statistics = {};
  if (files.size() > 1) header.tile_ends.clear(), header.round = 0;  // the plan of a single part
  FilmFormat format = first.film;
  for (const auto& file : files) {
    const PartHead head = read_part_head(file);
    const std::string difference =
        first.header.identity.difference(head.header.identity, files.front().string(), file.string());
    if (!difference.empty()) fail({}, "these are not parts of the same render. {}", difference);
    if (head.film.halves != format.halves)
      fail({}, "\"{}\" was rendered with --max-rms, \"{}\" without: they cannot be merged",
           (format.halves ? files.front() : file).string(), (format.halves ? file : files.front()).string());
    format.settings.crop = bounding_rectangle(format.settings.crop, head.film.settings.crop);
    if (format.splatting) format.splatting->sampled = bounding_rectangle(format.sampled(), head.film.sampled());
    header.request = std::max(header.request, head.header.request);
    header.adaptive |= head.header.adaptive;
    header.statistics += head.header.statistics;
  }
  Film sum(format);
  RenderPart whole{std::move(header), std::move(sum)};
  for (size_t i = 0; i < files.size(); ++i) {
    const Film film = read_part(files[i]).film;
    for (size_t t = 0; t < film.tiles(); ++t) {
      const Crop c = film.tile_pixels(t);
      const size_t tile = whole.film.tile_at(c.x0, c.y0);
      const bool is_cut = whole.film.tile(tile).samples_per_pixel() > 0;  // first halves need not fit together
      if (!whole.film.merge(tile, film.tile(t))) fail_with_overlap(files, i);
      if (is_cut && format.halves) whole.film.clear_first_half(tile);
    }
  }
  return whole;
}

ImageFormat finished_format(const RenderPart& part) {
  ImageFormat image = part.header.image;
  const SampleCount count = sample_count(part.film);
  const bool even = count.least == count.most;
  image.attributes["frond:samples"] =
      even ? fmt::format("{}", count.most) : fmt::format("{} to {}", count.least, count.most);
  if (even) image.samples = int(count.most);
  if (part.film.format().halves)
    image.attributes["frond:noise_rms"] = fmt::format("{:.6f}", image_noise(part.film, 0).rms());
  size_t list = 0;
  for (const ChannelInfo* channel : part.film.format().channels.infos()) {
    if (channel->kind == ChannelInfo::Kind::cryptomatte)
      image.attributes.merge(matte_attributes(channel->name, part.film, list, image.names));
    if (channel->is_matte()) ++list;
  }
  if (part.header.command.empty()) return image;
  std::string command = part.header.command;
  if (even) command += fmt::format(" --spp {}", count.most);
  if (const Crop& crop = part.film.settings().crop; crop != part.header.scene_crop)
    command += " --pixels " + text_of(scaled(crop, part.header.pixel_scale));
  image.attributes["frond:command"] = command;
  return image;
}

}  // namespace frond
