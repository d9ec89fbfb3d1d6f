#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/parallel.h"

namespace frond {

/// Integral of F(mu) mu^power over the cosines mu in [0, 1], F: Fresnel reflectance of an interface whose index of
/// refraction beyond over that on this side is `eta`. With power 1, half the reflectance for diffuse light.
double fresnel_moment(double eta, int power);

/// Light that a beam of normal incidence on a semi-infinite medium makes leave it, by distance: photon beam diffusion
/// (Habel, Christensen and Jarosz 2013) with single scattering, as in pbrt-v4. Distances are optical: in mean free
/// paths 1 / sigma_t. The first index is that of the medium's single-scattering albedo, sigma_s / sigma_t.
class BeamDiffusion {
 public:
  static constexpr size_t kAlbedos = 100, kRadii = 64;  ///< as in pbrt-v4

  /// `g`: mean cosine of the phase function. `eta`: index of refraction of the medium over that outside.
  BeamDiffusion(double g, double eta, const ThreadPool& pool);

  /// Share of the light that leaves, by single-scattering albedo: the integral of the profile over the plane.
  float reflectance(float albedo) const;
  /// Its inverse: the single-scattering albedo; clamped.
  float albedo(float reflectance) const;

 private:
  friend class BeamProfile;
  static constexpr size_t kSteps = 1024;  ///< of the inverse

  /// Albedo by the root of the spline of the reflectance.
  float find_albedo(float reflectance) const;

  std::vector<float> albedos_, radii_;
  std::vector<float> reflectance_;  ///< by albedo; may exceed 1
  std::vector<float> farthest_;     ///< by albedo: radius within which 0.999 of the light leaves
  std::vector<float> density_;      ///< by albedo and radius: 2 pi r times the profile
  std::vector<float> within_;       ///< its integral from 0
  std::vector<float> steps_;        ///< numbers from 0 to kSteps: equal steps of the square root of the reflectance
  std::vector<float> inverse_;      ///< albedo, by these steps
};

/// Profile of one single-scattering albedo: four rows of the table, interpolated by a spline. Where the method returns
/// more light than enters (without absorption 2 % more at eta 1.33; backward scattering), it is scaled down to that.
class BeamProfile {
 public:
  BeamProfile() = default;
  BeamProfile(const BeamDiffusion& table, float albedo);

  float reflectance() const { return reflectance_; }
  /// Radius beyond which no points are sampled, in mean free paths.
  float farthest() const { return farthest_; }
  /// Exitant flux per area and incident flux at an optical radius, 1 / (mean free path)^2.
  float at(float radius) const;
  /// Samples an optical radius, with the density 2 pi r at(r) / reflectance().
  float radius(float u) const;

 private:
  /// Interpolates a column of a table by albedo and radius.
  float row(const std::vector<float>& values, size_t radius) const;

  const BeamDiffusion* table_ = nullptr;
  size_t first_ = 0;                ///< first of the rows
  std::array<float, 4> weights_{};  ///< of the rows
  float reflectance_ = 0, farthest_ = 0;
};

}  // namespace frond
