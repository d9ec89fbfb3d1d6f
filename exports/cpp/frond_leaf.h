// SPDX-FileCopyrightText: 2026 The frond developers
// SPDX-License-Identifier: Apache-2.0
//
// The solved leaf for any C++ renderer: one header, C++17, without dependencies.
//
//   frond::Leaf leaf("soybean.leaf");                        // frond table leaf_solved ... -o soybean.leaf
//   frond::Leaf::At at = leaf.at(551.0);                     // once for a wavelength, and an optical depth if it varies
//   double f = leaf.f(at, incident, leaving);                // 1/sr, without cosine
//   frond::Leaf::Sample s = leaf.sample(at, incident, u0, u1, u2);
//
// Directions are unit vectors that point away from the surface, z along its normal, which is the leaf's adaxial side. Of a
// leaf that is not reciprocal `incident` is the direction that the model calls so: toward the light for energy that is kept,
// toward the camera as published. File format: docs/file_formats.md; formulas: docs/leaf_models.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace frond {

class Leaf {
 public:
  struct Direction {
    double x, y, z;
  };

  /// Throws std::runtime_error for a file that cannot be read, is of another kind, or is damaged.
  explicit Leaf(const std::string& path) : Leaf(bytes_of(path), path) {}
  /// The same from memory; `name` is what errors call it.
  Leaf(const std::string& bytes, const std::string& name) {
    Reader in{bytes, name, 8};
    if (bytes.compare(0, 8, "FRONDLF1") != 0) throw std::runtime_error(name + ": not a .leaf file of frond");
    if (bytes.size() < 60 || checksum(bytes) != stored_checksum(bytes)) in.refuse();
    reciprocal_ = in.whole() != 0;
    cells_ = in.whole();
    const size_t wavelengths = in.whole(), depths = in.whole();
    for (auto& of_side : modes_)
      for (size_t& modes : of_side) modes = in.whole();
    if (cells_ == 0 || wavelengths == 0) in.refuse();
    exponent_ = in.floats({1})[0];
    wavelengths_ = in.floats({wavelengths});
    depths_ = in.floats({depths});
    index_ = in.floats({wavelengths});
    const size_t least_depths = depths > 0 && depths_[0] == 0 ? 3 : 2;
    if (!increases(wavelengths_, 0) || (depths > 0 && (depths < least_depths || !increases(depths_, 0))) || exponent_ < 0)
      in.refuse();
    for (const float index : index_)
      if (index < 1) in.refuse();
    surface_ = in.floats({reciprocal_ ? wavelengths : 1, kCosineCells + 1});
    const size_t rows = std::max<size_t>(1, depths);  // of a wavelength
    for (size_t s = 0; s < 2; ++s)
      for (size_t w = 0; w < 2; ++w) series_[s][w] = in.floats({wavelengths, rows, modes_[s][w], side(), side()});
    for (auto& ways : ways_) ways = in.floats({wavelengths, rows, side(), 2});
  }

  bool is_reciprocal() const { return reciprocal_; }
  const std::vector<float>& wavelengths_nm() const { return wavelengths_; }
  /// Optical depths of the mesophyll; empty: the leaf's own at each wavelength.
  const std::vector<float>& depths() const { return depths_; }

  /// Interpolation in the table at one wavelength and depth.
  struct At {
    std::array<size_t, 4> column{};
    std::array<double, 4> weight{};
    int columns = 0;
    std::array<size_t, 2> row{};  // of wavelengths
    double t = 0;                 // of the way from one to the other
    double index = 1;
  };

  /// Between the table's wavelengths; beyond them the nearest holds.
  At at(double lambda_nm, double optical_depth = 0) const {
    At a;
    if (wavelengths_.size() > 1) {
      const auto above = std::upper_bound(wavelengths_.begin() + 1, wavelengths_.end() - 1, float(lambda_nm));
      a.row[1] = size_t(above - wavelengths_.begin());
      a.row[0] = a.row[1] - 1;
      const double low = wavelengths_[a.row[0]], high = wavelengths_[a.row[1]];
      a.t = std::clamp((lambda_nm - low) / (high - low), 0.0, 1.0);
    }
    a.index = (1 - a.t) * index_[a.row[0]] + a.t * index_[a.row[1]];
    for (int i = 0; i < (a.t > 0 ? 2 : 1); ++i) {
      const double weight = i == 0 ? 1 - a.t : a.t;
      if (depths_.empty()) {
        a.column[size_t(a.columns)] = a.row[size_t(i)];
        a.weight[size_t(a.columns++)] = weight;
        continue;
      }
      const auto [below, t] = depth_cell(optical_depth);
      for (int k = 0; k < 2; ++k) {
        a.column[size_t(a.columns)] = a.row[size_t(i)] * depths_.size() + below + size_t(k);
        a.weight[size_t(a.columns++)] = weight * (k == 0 ? 1 - t : t);
      }
    }
    return a;
  }

  /// 1/sr, without cosine. 0 along the surface itself.
  double f(const At& at, const Direction& incident, const Direction& leaving) const {
    if (std::abs(incident.z) < 1e-20 || std::abs(leaving.z) < 1e-20) return 0;
    const bool crosses = incident.z * leaving.z < 0;
    const Passage in = passage(std::abs(incident.z), at.index), out = passage(std::abs(leaving.z), at.index);
    const double body = series(at, crosses, incident, leaving) * in.through * (reciprocal_ ? out.through : out.over_cosine);
    return crosses ? body : body + surface(at, incident, leaving, in, out);
  }

  struct Sample {
    Direction leaving;
    double weight = 0;  ///< f |cos theta| / pdf; 0: nothing leaves
    double pdf = 0;     ///< 1/sr
  };

  /// From three uniform numbers in [0, 1). Weights are bounded.
  Sample sample(const At& at, const Direction& incident, double u0, double u1, double u2) const {
    Sample s;
    if (std::abs(incident.z) < 1e-20) return s;
    const std::array<double, 3> share = shares(at, incident);
    const double up = std::copysign(1.0, incident.z), two_pi = 6.283185307179586;
    if (u0 < share[0]) {
      const double cos_alpha = std::pow(1 - u1, 1 / (exponent_ + 1));
      const double sin_alpha = std::sqrt(std::max(0.0, 1 - cos_alpha * cos_alpha));
      s.leaving = around({-incident.x, -incident.y, incident.z}, sin_alpha * std::cos(two_pi * u2),
                         sin_alpha * std::sin(two_pi * u2), cos_alpha);
      s.leaving.z = up * std::abs(s.leaving.z);  // what goes below the plane is turned up again
    } else {
      const double sign = u0 < share[0] + share[1] ? up : -up, radius = std::sqrt(u1);
      s.leaving = {radius * std::cos(two_pi * u2), radius * std::sin(two_pi * u2), sign * std::sqrt(1 - u1)};
    }
    s.pdf = pdf(at, incident, s.leaving);
    if (s.pdf > 0) s.weight = f(at, incident, s.leaving) * std::abs(s.leaving.z) / s.pdf;
    return s;
  }

  double pdf(const At& at, const Direction& incident, const Direction& leaving) const {
    if (std::abs(incident.z) < 1e-20 || std::abs(leaving.z) < 1e-20) return 0;
    const std::array<double, 3> share = shares(at, incident);
    const double cosine = std::abs(leaving.z) / kPi;
    if (incident.z * leaving.z < 0) return share[2] * cosine;
    return share[0] * (lobe(incident, leaving) + lobe(incident, {leaving.x, leaving.y, -leaving.z})) + share[1] * cosine;
  }

 private:
  static constexpr double kPi = 3.141592653589793;
  static constexpr size_t kCosineCells = 64;

  struct Reader {
    const std::string& bytes;
    const std::string& name;
    size_t at;
    uint32_t whole() {
      uint32_t value;
      std::memcpy(&value, take(sizeof value), sizeof value);
      return value;
    }
    /// An array of these dimensions, of finite numbers. None is larger than the file, however large the dimensions.
    std::vector<float> floats(std::initializer_list<size_t> dimensions) {
      size_t count = 1;
      for (const size_t d : dimensions) {
        if (d > 0 && count > bytes.size() / d) refuse();
        count *= d;
      }
      const char* data = take(count * sizeof(float));
      std::vector<float> values(count);
      if (count > 0) std::memcpy(values.data(), data, count * sizeof(float));
      for (const float value : values)
        if (!std::isfinite(value)) refuse();
      return values;
    }
    const char* take(size_t size) {
      if (size > bytes.size() - at) throw std::runtime_error(name + ": the file is truncated");
      at += size;
      return bytes.data() + at - size;
    }
    [[noreturn]] void refuse() const { throw std::runtime_error(name + ": damaged"); }
  };

  static bool increases(const std::vector<float>& values, float least) {
    for (size_t i = 0; i < values.size(); ++i)
      if (values[i] < least || (i > 0 && values[i] <= values[i - 1])) return false;
    return true;
  }
  static std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// FNV-1a over all but the last eight bytes, mixed.
  static uint64_t checksum(const std::string& bytes) {
    uint64_t h = 0xcbf29ce484222325ull;
    for (size_t i = 0; i + 8 < bytes.size(); ++i) h = (h ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3ull;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
    return h ^ (h >> 31);
  }
  static uint64_t stored_checksum(const std::string& bytes) {
    uint64_t value;
    std::memcpy(&value, bytes.data() + bytes.size() - 8, 8);
    return value;
  }

  size_t side() const { return cells_ + 3; }

  struct Cell {
    size_t below;
    double t;
  };
  Cell depth_cell(double depth) const {
    const size_t zero = depths_[0] == 0 ? 1 : 0, steps = depths_.size() - zero - 1;
    const double first = depths_[zero], last = depths_.back();
    if (depth <= first) return {0, zero == 1 ? std::max(0.0, depth / first) : 0.0};
    const double x = std::min(std::log(depth / first) / std::log(last / first), 1.0) * double(steps);
    const size_t cell = std::min(size_t(x), steps - 1);
    return {zero + cell, x - double(cell)};
  }

  /// Weights of the cubic through -1, 0, 1, 2 at t in [0, 1].
  static std::array<double, 4> cubic(double t) {
    return {t * (-2 + t * (3 - t)) / 6, 1 + t * (-3 + t * (-6 + 3 * t)) / 6, t * (6 + t * (3 - 3 * t)) / 6, t * (t * t - 1) / 6};
  }
  struct Nodes {
    size_t first;
    std::array<double, 4> weight;
  };
  Nodes nodes(double sine) const {
    const double x = sine * double(cells_);
    const size_t below = std::min(size_t(x), cells_ - 1);
    return {below, cubic(x - double(below))};
  }
  static double sine(const Direction& w) { return std::sqrt(std::min(w.x * w.x + w.y * w.y, 1.0)); }

  struct Passage {
    double through, over_cosine;  // 1 - F, and the same over the cosine inside
  };
  static Passage passage(double cosine, double n) {
    const double q = std::sqrt(n * n - (1 - cosine * cosine)), s = cosine + q, p = n * n * cosine + q;
    const double part = 2 * cosine * (p * p + n * n * s * s) / (s * p * s * p);
    return {q * part, n * part};
  }

  double series(const At& at, bool crosses, const Direction& incident, const Direction& leaving) const {
    const double sine_i = sine(incident), sine_o = sine(leaving), sines = sine_i * sine_o;
    const double cos_phi =
        sines > 0 ? std::clamp(-(incident.x * leaving.x + incident.y * leaving.y) / sines, -1.0, 1.0) : 1;
    // Of a reciprocal leaf both orders of directions read the same entries of the table.
    const bool swaps = reciprocal_ && (crosses ? incident.z > 0 : sine_i < sine_o);
    const Nodes i = nodes(swaps ? sine_o : sine_i), o = nodes(swaps ? sine_i : sine_o);
    const bool below = (swaps ? leaving.z : incident.z) < 0;
    const size_t modes = modes_[below][crosses];
    const std::vector<float>& table = series_[below][crosses];
    double total = 0;
    for (int c = 0; c < at.columns; ++c) {
      double sum = 0, now = 1, before = cos_phi;  // cos m phi
      for (size_t m = 0; m < modes; ++m) {
        const float* grid = &table[(at.column[size_t(c)] * modes + m) * side() * side() + i.first * side() + o.first];
        double patch = 0;
        for (size_t a = 0; a < 4; ++a)
          for (size_t b = 0; b < 4; ++b) patch += i.weight[a] * o.weight[b] * double(grid[a * side() + b]);
        sum += now * patch;
        const double next = 2 * cos_phi * now - before;
        before = now, now = next;
      }
      total += at.weight[size_t(c)] * sum;
    }
    return std::max(total, 0.0);
  }

  /// Divisor of the surface's lobe.
  double divisor(const At& at, double cosine) const {
    const double x = std::sqrt(std::min(cosine, 1.0)) * double(kCosineCells);
    const size_t below = size_t(std::clamp(std::floor(x) - 1, 0.0, double(kCosineCells - 3)));
    const std::array<double, 4> w = cubic(x - double(below) - 1);
    const auto row = [&](size_t r) {
      double sum = 0;
      for (size_t i = 0; i < 4; ++i) sum += w[i] * double(surface_[r * (kCosineCells + 1) + below + i]);
      return sum;
    };
    return reciprocal_ ? (1 - at.t) * row(at.row[0]) + at.t * row(at.row[1]) : row(0);
  }

  double lobe(const Direction& incident, const Direction& leaving) const {
    const double cos_alpha = -incident.x * leaving.x - incident.y * leaving.y + incident.z * leaving.z;
    return cos_alpha > 0 ? (exponent_ + 1) / (2 * kPi) * std::pow(cos_alpha, exponent_) : 0;
  }

  double surface(const At& at, const Direction& incident, const Direction& leaving, const Passage& in,
                 const Passage& out) const {
    const double cos_i = std::abs(incident.z), cos_o = std::abs(leaving.z), spread = lobe(incident, leaving);
    if (reciprocal_) return (1 - in.through) / divisor(at, cos_i) * (1 - out.through) / divisor(at, cos_o) * spread;
    return (1 - in.through) * spread / (divisor(at, cos_i) * cos_o);
  }

  /// Probabilities of the surface's lobe and of cosine lobes on this side and on the other.
  std::array<double, 3> shares(const At& at, const Direction& incident) const {
    const double enters = passage(std::abs(incident.z), at.index).through;
    const Nodes n = nodes(sine(incident));
    double back = 0, across = 0;
    for (int c = 0; c < at.columns; ++c)
      for (size_t i = 0; i < 4; ++i) {
        const float* way = &ways_[incident.z < 0][(at.column[size_t(c)] * side() + n.first + i) * 2];
        back += enters * at.weight[size_t(c)] * n.weight[i] * double(way[0]);
        across += enters * at.weight[size_t(c)] * n.weight[i] * double(way[1]);
      }
    const double least = 0.01 * (1 - enters + std::max(back, 0.0) + std::max(across, 0.0));
    back = std::max(back, least), across = std::max(across, least);
    const double all = 1 - enters + back + across;
    return {(1 - enters) / all, back / all, across / all};
  }

  static Direction around(const Direction& z, double x, double y, double along) {
    const double sign = std::copysign(1.0, z.z), a = -1 / (sign + z.z), b = z.x * z.y * a;
    const Direction s{1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, t{b, sign + z.y * z.y * a, -z.y};
    return {x * s.x + y * t.x + along * z.x, x * s.y + y * t.y + along * z.y, x * s.z + y * t.z + along * z.z};
  }

  bool reciprocal_ = false;
  size_t cells_ = 0;
  double exponent_ = 0;
  std::vector<float> wavelengths_, depths_, index_, surface_;
  std::array<std::array<size_t, 2>, 2> modes_{};              // [lit from below][crosses]
  std::array<std::array<std::vector<float>, 2>, 2> series_;   // [column][mode][incident sine][leaving sine]
  std::array<std::vector<float>, 2> ways_;                    // [column][incident sine][back, across]
};

}  // namespace frond
