#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <span>

#include "core/camera.h"
#include "core/filter.h"
#include "core/integrator.h"
#include "core/parallel.h"
#include "core/wavelengths.h"
#include "scene/film.h"

namespace frond {

/// A pixel of the whole picture.
struct PixelPlace {
  int x, y;
};

/// The parts of one render. All of them are shared by the threads, none is changed.
struct RenderJob {
  const World& world;
  const Camera& camera;
  const Integrator& integrator;
  const WavelengthStrategy& wavelengths;
  const Filter& filter;
  const Sampler& sampler;
  uint64_t seed;
  uint64_t first_sample, samples;  ///< of each pixel
  /// Which pixels of the picture the film's stand for, row by row: some of them, drawn from all. Empty: themselves.
  std::span<const PixelPlace> places = {};
};

/// How paths ended after so many scattering events; from kDepths - 1 on together in the last one.
struct PathEnds {
  static constexpr size_t kDepths = 64;
  std::array<uint64_t, kDepths> escaped{}, absorbed{};  ///< left the scene; were absorbed or cut off

  void add(const PathResult& path) {
    const size_t depth = std::min(size_t(path.scatterings), kDepths - 1);
    ++(path.escaped ? escaped : absorbed)[depth];
  }
  /// Paths that went on after so many scattering events, below kDepths.
  uint64_t alive_after(size_t events) const {
    return std::accumulate(escaped.begin() + events, escaped.end(), uint64_t{0}) +
           std::accumulate(absorbed.begin() + events, absorbed.end(), uint64_t{0});
  }
  PathEnds& operator+=(const PathEnds& other) {
    for (size_t i = 0; i < kDepths; ++i) escaped[i] += other.escaped[i], absorbed[i] += other.absorbed[i];
    return *this;
  }
};

struct RenderStatistics {
  uint64_t paths = 0, rays = 0;
  double wall_seconds = 0, cpu_seconds = 0;
  PathEnds ends;
};

/// What has been done so far, told from one thread at a time.
using Progress = std::function<void(double fraction, const RenderStatistics&)>;

/// Adds the job's samples to the film. The film depends on the job alone, not on the threads.
RenderStatistics render(const RenderJob& job, Film& film, const ThreadPool& pool, const Progress& progress);

}  // namespace frond
