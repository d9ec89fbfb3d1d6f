#include "instruments/fluorescence_matrix.h"

#include <atomic>
#include <bit>

#include "core/stop.h"
#include "instruments/beam.h"

namespace frond {
namespace {

using Cell = FluorescenceMatrix::Cell;

Cell measure_cell(const Fluorescence& fluorescence, const Vec3& light, double emission_nm, double excitation_nm,
                  int64_t rays, RandomStream& rng) {
  Moments absorbed, emitted, reabsorbed, lit_side, opposite_side;
  StopPoll poll;
  for (int64_t i = 0; i < rays; ++i, poll()) {
    const FluorescencePhotons photons = fluorescence.photons(light, emission_nm, excitation_nm, rng);
    absorbed.add(photons.absorbed), emitted.add(photons.emitted), reabsorbed.add(photons.reabsorbed);
    lit_side.add(photons.lit_side), opposite_side.add(photons.opposite_side);
  }
  return {absorbed.estimate(), emitted.estimate(), reabsorbed.estimate(), lit_side.estimate(),
          opposite_side.estimate()};
}

}  // namespace

Estimate FluorescenceMatrix::integral(size_t excitation, Estimate Cell::*member) const {
  Estimate sum;
  const size_t count = emission_nm.size();
  for (size_t i = 0; i < count; ++i) {
    const double from = emission_nm[i > 0 ? i - 1 : 0], to = emission_nm[std::min(i + 1, count - 1)];
    const double weight = (to - from) / 2;
    const Estimate& e = at(excitation, i).*member;
    sum += Estimate{weight * e.mean, weight * weight * e.variance, weight * weight * weight * e.third_cumulant};
  }
  return sum;
}

FluorescenceMatrix measure_fluorescence(const Fluorescence& fluorescence, const FluorescenceRequest& request,
                                        const ThreadPool& pool, const std::function<void(double)>& progress) {
  check_rays(request.rays);
  FluorescenceMatrix matrix{request.theta_deg, request.excitation_nm, request.emission_nm};
  matrix.rays = fluorescence.is_noisy() ? request.rays : 0;
  matrix.cells.resize(request.excitation_nm.size() * request.emission_nm.size());
  const Vec3 light = toward_light({request.theta_deg, request.excitation_nm.front()});
  std::atomic<size_t> done = 0;
  pool.for_each(static_cast<int64_t>(matrix.cells.size()), [&](int64_t index, int worker) {
    const auto i = static_cast<size_t>(index), emissions = request.emission_nm.size();
    const double excitation_nm = request.excitation_nm[i / emissions], emission_nm = request.emission_nm[i % emissions];
    RandomStream rng(hash_key(request.seed, std::bit_cast<uint64_t>(request.theta_deg),
                              std::bit_cast<uint64_t>(excitation_nm), std::bit_cast<uint64_t>(emission_nm)));
    // Without noise a single call is the mean; its variance is 0.
    const int64_t rays = matrix.rays > 0 ? matrix.rays : 1;
    matrix.cells[i] = measure_cell(fluorescence, light, emission_nm, excitation_nm, rays, rng);
    const size_t count = ++done;
    if (worker == 0 && progress) progress(double(count) / double(matrix.cells.size()));
  });
  return matrix;
}

}  // namespace frond
