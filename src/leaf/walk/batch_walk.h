#pragma once

#include <span>

#include "leaf/walk/walk.h"

namespace frond::leaf {

namespace batch {
struct Kernel;
}

/// Where a ray of a batch went.
struct BatchRay {
  Vec3 wi;       ///< unit, z not 0; a null vector where absorbed
  float weight;  ///< 1 in analog walks; 0 where absorbed
  Fate fate;
};

/// The walk of walk.h for many rays of one wavelength and one direction, in single precision and many at a time: for
/// instruments and tables. Ray `first` + i is out[i]. Each has random numbers of its own, so that it depends on the
/// tissue, wo, the absorption, the key and its number alone: not on the other rays, nor on the machine's instructions,
/// of which the widest are chosen at run time.
///
/// A ray that total reflection holds without end between two smooth, clear interfaces (indices that no leaf has) counts
/// as absorbed.
void walk_batch(const Tissue& tissue, const Vec3d& wo, Absorption absorption, uint64_t key, std::span<BatchRay> out,
                uint64_t first = 0);

/// The kernels that this machine can run, the fastest first; all of them give the same bits.
std::span<const batch::Kernel* const> batch_kernels();
std::string_view name_of(const batch::Kernel& kernel);
void walk_batch(const batch::Kernel& kernel, const Tissue& tissue, const Vec3d& wo, Absorption absorption, uint64_t key,
                std::span<BatchRay> out, uint64_t first = 0);

}  // namespace frond::leaf
