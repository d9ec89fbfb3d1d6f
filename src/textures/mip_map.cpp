#include "textures/mip_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/stop.h"
#include "image/rgb_file.h"

namespace frond {
namespace {

/// Returns the non-negative remainder.
int modulo(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

/// Contribution of old rows or columns to a new one; all new ones cover equal shares.
struct Share {
  int first;
  std::array<float, 4> weights{};
};

/// Returns the weights for resampling `from` texels to `to`; sizes need not be powers of two.
std::vector<Share> shares(int from, int to) {
  std::vector<Share> all;
  const double width = double(from) / to;
  for (int i = 0; i < to; ++i) {
    Share s{int(i * width), {}};
    for (int k = 0; k < 4 && s.first + k < from; ++k)
      s.weights[size_t(k)] =
          float(std::max(0.0, std::min((i + 1) * width, s.first + k + 1.0) - std::max(i * width, double(s.first + k))) /
                width);
    all.push_back(s);
  }
  return all;
}

/// Largest magnitude of a component.
float max_component(Vec2 v) { return std::max(std::abs(v.x), std::abs(v.y)); }
float length_of(Vec2 v) { return std::sqrt(v.x * v.x + v.y * v.y); }

/// Gaussian by squared distance from the ellipse's centre, 0 at the edge (Heckbert 1989).
constexpr size_t kEllipseSteps = 128;
/// Weights by squared distance, so that no square root is needed.
std::array<float, kEllipseSteps> make_ellipse_weights() {
  std::array<float, kEllipseSteps> w{};
  for (size_t i = 0; i < w.size(); ++i) w[i] = std::exp(-2 * float(i) / float(w.size() - 1)) - std::exp(-2.f);
  return w;
}
const std::array<float, kEllipseSteps> kEllipseWeights = make_ellipse_weights();

}  // namespace

/// Decodes one value.
float ColorEncoding::decode(float v) const {
  switch (curve) {
    case Curve::srgb:
      return decode_srgb(v);
    case Curve::power:
      return std::pow(std::max(v, 0.f), gamma);
    case Curve::linear:
      break;
  }
  return v;
}

MipMap::MipMap(const Image& image, const ColorEncoding& encoding, bool eight_bit, const Options& options)
    : options_(options), channels_(int(image.channels.size())), size_(float(std::max(image.width, image.height))) {
  Level level{image.width, image.height, {}, {}};
  if (eight_bit) {
    level.bytes.reserve(image.pixels.size());
    for (const float v : image.pixels) level.bytes.push_back(uint8_t(std::lround(std::clamp(v, 0.f, 1.f) * 255)));
    // A table replaces the decoding of each lookup, since a byte has 256 values.
    for (int i = 0; i < 256; ++i) decoded_.push_back(encoding.decode(float(i) / 255));
  } else {
    level.values.reserve(image.pixels.size());
    StopPoll poll;
    for (const float v : image.pixels) {
      poll();
      level.values.push_back(encoding.decode(v));
    }
  }
  levels_.push_back(std::move(level));
  // Sizes are halved and rounded down to a last level of one texel.
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halved(levels_.back()));
}

/// Box filter over linear values.
MipMap::Level MipMap::halved(const Level& from) const {
  Level to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}, {}};
  to.values.reserve(size_t(to.width) * size_t(to.height) * size_t(channels_));
  const auto columns = shares(from.width, to.width), rows = shares(from.height, to.height);
  for (const Share& row : rows) {
    check_stop();
    for (const Share& column : columns) {
      Float4 sum{};
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
          if (const float w = row.weights[size_t(j)] * column.weights[size_t(i)]; w > 0)
            sum += w * value(from, size_t(row.first + j) * size_t(from.width) + size_t(column.first + i));
      for (int c = 0; c < channels_; ++c) to.values.push_back(sum[c]);
    }
  }
  return to;
}

/// Returns the linear value of a stored texel.
Float4 MipMap::value(const Level& level, size_t index) const {
  if (channels_ == 1) return Float4{level.bytes.empty() ? level.values[index] : decoded_[level.bytes[index]], 0, 0, 0};
  if (level.bytes.empty()) {
    const float* v = &level.values[3 * index];
    return Float4{v[0], v[1], v[2], 0};
  }
  const uint8_t* v = &level.bytes[3 * index];
  return Float4{decoded_[v[0]], decoded_[v[1]], decoded_[v[2]], 0};
}

/// Applies the wrap mode to coordinates outside of the image.
Float4 MipMap::texel(const Level& level, int x, int y) const {
  const int w = level.width, h = level.height;
  if (x < 0 || y < 0 || x >= w || y >= h) switch (options_.wrap) {
      case Wrap::black:
        return Float4{};
      case Wrap::repeat:
        x = modulo(x, w), y = modulo(y, h);
        break;
      case Wrap::octahedral_sphere:
        // Beyond an edge, the same edge continues in reverse direction.
        if (x < 0 || x >= w) x = x < 0 ? -x - 1 : 2 * w - 1 - x, y = h - 1 - y;
        if (y < 0 || y >= h) y = y < 0 ? -y - 1 : 2 * h - 1 - y, x = w - 1 - x;
        [[fallthrough]];
      case Wrap::clamp:
        x = std::clamp(x, 0, w - 1), y = std::clamp(y, 0, h - 1);
        break;
    }
  return value(level, size_t(y) * size_t(w) + size_t(x));
}

/// Interpolates between four texel centres.
Float4 MipMap::bilinear(const Level& level, Vec2 st) const {
  const float x = st.x * float(level.width) - 0.5f, y = st.y * float(level.height) - 0.5f;
  const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  const int i = int(x0), j = int(y0);
  const Float4 above = (1 - fx) * texel(level, i, j) + fx * texel(level, i + 1, j);
  const Float4 below = (1 - fx) * texel(level, i, j + 1) + fx * texel(level, i + 1, j + 1);
  return (1 - fy) * above + fy * below;
}

/// Coordinates are reduced first, because large values lose precision.
Float4 MipMap::at(const TextureCoordinates& place) const {
  Vec2 st{place.st.x, 1 - place.st.y};
  if (options_.wrap == Wrap::repeat) {
    st = {st.x - std::floor(st.x), st.y - std::floor(st.y)};
  } else {
    constexpr float kFar = 8;  // largest distance from the edges that matters
    st = {std::clamp(st.x, -kFar, kFar), std::clamp(st.y, -kFar, kFar)};
  }
  if (!std::isfinite(st.x) || !std::isfinite(st.y)) return Float4{};
  return filtered({st, {place.dst_dx.x, -place.dst_dx.y}, {place.dst_dy.x, -place.dst_dy.y}});
}

/// Selects the level whose texels are half as wide as the footprint (pbrt 4th ed., 10.4.3).
Float4 MipMap::filtered(const TextureCoordinates& place) const {
  if (options_.filter == Filter::ewa) return filter_ellipse(place);
  const float texels = 2 * std::max(max_component(place.dst_dx), max_component(place.dst_dy)) * size_;
  const float level = texels > 1 ? std::log2(texels) : 0;
  const size_t last = levels_.size() - 1;
  if (!(level < float(last))) return value(levels_[last], 0);
  const size_t at = size_t(level);
  if (options_.filter == Filter::point) {
    const Level& l = levels_[at];
    return texel(l, int(std::floor(place.st.x * float(l.width))), int(std::floor(place.st.y * float(l.height))));
  }
  if (options_.filter == Filter::bilinear || at == 0) return bilinear(levels_[at], place.st);
  // Trilinear: interpolates linearly between two levels (Williams 1983).
  const float t = level - float(at);
  return (1 - t) * bilinear(levels_[at], place.st) + t * bilinear(levels_[at + 1], place.st);
}

/// Filters over the footprint's ellipse, between the two levels on which its minor axis is about a texel, with limited
/// anisotropy (Heckbert 1989; pbrt 4th ed., 10.4.4).
Float4 MipMap::filter_ellipse(const TextureCoordinates& place) const {
  const float along_x = length_of(place.dst_dx), along_y = length_of(place.dst_dy);
  const float length = std::max(along_x, along_y), narrow = std::min(along_x, along_y);
  if (!(narrow > 0) || !std::isfinite(length)) return bilinear(levels_[0], place.st);
  const float widening = std::max(1.f, length / (narrow * options_.max_anisotropy));
  const Vec2 p = place.dst_dx * (along_x < along_y ? widening : 1),
             q = place.dst_dy * (along_x < along_y ? 1 : widening);
  const float level = std::clamp(std::log2(narrow * widening * size_), 0.f, float(levels_.size()));
  const size_t finer = size_t(level);
  const float t = level - float(finer);
  return (1 - t) * ellipse(finer, place.st, p, q) + t * ellipse(finer + 1, place.st, p, q);
}

/// Weights texels by a Gaussian with the covariance of the axes p and q plus a texel's extent, truncated at 1.
Float4 MipMap::ellipse(size_t index, Vec2 st, Vec2 p, Vec2 q) const {
  if (index >= levels_.size()) return value(levels_.back(), 0);
  const Level& level = levels_[index];
  const float w = float(level.width), h = float(level.height), x = st.x * w - 0.5f, y = st.y * h - 0.5f;
  // Coefficients of the implicit ellipse of the level, in texels; 1 is the variance of the reconstruction filter.
  const float xx = w * w * (p.x * p.x + q.x * q.x) + 1, yy = h * h * (p.y * p.y + q.y * q.y) + 1;
  const float xy = w * h * (p.x * p.y + q.x * q.y), determinant = xx * yy - xy * xy;
  const float reach_x = std::sqrt(xx), reach_y = std::sqrt(yy);
  constexpr float kMost = 1 << 12;  // upper bound of an ellipse's width at this anisotropy and level
  if (!(reach_x < kMost && reach_y < kMost && determinant > 0)) return bilinear(level, st);
  constexpr auto kLast = float(kEllipseSteps - 1);
  Float4 sum{};
  float weights = 0;
  for (int j = int(std::ceil(y - reach_y)); j <= int(std::floor(y + reach_y)); ++j)
    for (int i = int(std::ceil(x - reach_x)); i <= int(std::floor(x + reach_x)); ++i) {
      const float dx = float(i) - x, dy = float(j) - y;
      const float square = (yy * dx * dx - 2 * xy * dx * dy + xx * dy * dy) / determinant;
      if (!(square < 1)) continue;
      const float weight = kEllipseWeights[size_t(std::min(square * float(kEllipseSteps), kLast))];
      sum += weight * texel(level, i, j);
      weights += weight;
    }
  return weights > 0 ? sum / weights : bilinear(level, st);
}

}  // namespace frond
