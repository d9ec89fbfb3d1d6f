#pragma once

#include <span>

#include "leaf/walk/walk.h"

namespace frond::leaf {

namespace batch {
struct Kernel;
}

/// Result of one ray of a batch.
struct BatchRay {
  Vec3 wi;       ///< unit, z not 0; a null vector if absorbed
  float weight;  ///< 1 in analog walks; 0 if absorbed
  Fate fate;
};

/// The walk of walk.h for many rays of one wavelength and one direction, in single precision and many at a time, for
/// instruments and tables. Ray `first` + i is out[i]. Each ray has its own random numbers: it depends on the tissue,
/// wo, the absorption, the key and its index alone, not on other rays or on the machine's SIMD instructions, of which
/// the widest are selected at run time.
///
/// A ray that total reflection keeps between two smooth, clear interfaces without end (indices that no leaf has) counts
/// as absorbed.
void walk_batch(const Tissue& tissue, const Vec3d& wo, Absorption absorption, uint64_t key, std::span<BatchRay> out,
                uint64_t first = 0);

/// The kernels that this machine can run, the fastest first; all of them give the same bits.
std::span<const batch::Kernel* const> batch_kernels();
/// Name of a kernel's instruction set.
std::string_view name_of(const batch::Kernel& kernel);
/// The same with a given kernel, for tests and benchmarks.
void walk_batch(const batch::Kernel& kernel, const Tissue& tissue, const Vec3d& wo, Absorption absorption, uint64_t key,
                std::span<BatchRay> out, uint64_t first = 0);

}  // namespace frond::leaf
