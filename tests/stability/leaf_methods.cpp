#include "tests/stability/leaf_methods.h"

#include <bit>
#include <numbers>

#include "leaf/walk/batch_walk.h"

namespace frond::stability {

using leaf::Absorption;
using leaf::Fate;
using leaf::Shares;
using leaf::Tissue;

namespace {

constexpr int kMethodWalks = 5000, kBatchedWalks = 50000;

Cell walked(const Tissue& tissue, const Lit& lit, Absorption absorption) {
  Comparison comparison;
  for (size_t i = 0; i < lit.theta_deg.size(); ++i)
    add_shares(comparison, walk_many(tissue, lit.theta_deg[i], absorption, kMethodWalks), lit.truth[i]);
  return comparison.cell();
}

Cell walked_in_batch(const Tissue& tissue, const Lit& lit) {
  Comparison comparison;
  for (size_t i = 0; i < lit.theta_deg.size(); ++i)
    for (const Absorption absorption : {Absorption::analog, Absorption::weighted})
      add_shares(comparison, walk_many_in_batch(tissue, lit.theta_deg[i], absorption, kBatchedWalks), lit.truth[i]);
  return comparison.cell();
}

Cell solved(const Tissue& tissue, const Lit& lit, double bound) {
  Comparison comparison(bound);
  const std::vector<Shares> shares = leaf::solve(tissue, lit.theta_deg);
  for (size_t i = 0; i < shares.size(); ++i) add_shares(comparison, shares[i], lit.truth[i]);
  return comparison.cell();
}

}  // namespace

void MeasuredShares::add(Fate fate, double weight) {
  surface.add(fate == Fate::surface ? weight : 0);
  subsurface.add(fate == Fate::reflected ? weight : 0);
  transmitted.add(fate == Fate::transmitted ? weight : 0);
  all.add(weight);
}

Vec3d toward(double theta_deg) {
  const double theta = theta_deg * std::numbers::pi / 180;
  return {std::sin(theta), 0, std::cos(theta)};
}

MeasuredShares walk_many(const Tissue& tissue, double theta_deg, Absorption absorption, int rays) {
  MeasuredShares measured;
  RandomStream rng(hash_key(1, std::bit_cast<uint64_t>(theta_deg), static_cast<uint64_t>(absorption)));
  for (int i = 0; i < rays; ++i) {
    const leaf::WalkEnd end = leaf::walk(tissue, toward(theta_deg), absorption, rng);
    measured.add(end.fate, end.weight);
  }
  return measured;
}

MeasuredShares walk_many_in_batch(const Tissue& tissue, double theta_deg, Absorption absorption, int rays) {
  std::vector<leaf::BatchRay> batch(static_cast<size_t>(rays));
  leaf::walk_batch(tissue, toward(theta_deg), absorption, 1, batch);
  MeasuredShares measured;
  for (const leaf::BatchRay& ray : batch) measured.add(ray.fate, double(ray.weight));
  return measured;
}

Lit solved_finely(const Tissue& tissue, const std::vector<double>& theta_deg) {
  return {theta_deg, leaf::solve(tissue, theta_deg, 2 * leaf::solver_nodes(tissue))};
}

void add_shares(Comparison& comparison, const MeasuredShares& measured, const Shares& truth) {
  const int64_t rays = measured.all.count();
  comparison.add("Rs", measured.surface.estimate(), truth.surface, rays);
  comparison.add("Rd", measured.subsurface.estimate(), truth.subsurface, rays);
  comparison.add("T", measured.transmitted.estimate(), truth.transmitted, rays);
  comparison.add("Rs + Rd + T", measured.all.estimate(), truth.surface + truth.subsurface + truth.transmitted, rays);
}

void add_shares(Comparison& comparison, const Shares& value, const Shares& truth) {
  comparison.add("Rs", value.surface, truth.surface);
  comparison.add("Rd", value.subsurface, truth.subsurface);
  comparison.add("T", value.transmitted, truth.transmitted);
}

void compare_tissue_methods(Row& row, const Tissue& tissue, const Lit& lit, double solver_bound) {
  row.add(Method::walk_analog, walked(tissue, lit, Absorption::analog));
  row.add(Method::walk_weighted, walked(tissue, lit, Absorption::weighted));
  row.add(Method::batch, walked_in_batch(tissue, lit));
  row.add(Method::solver, solved(tissue, lit, solver_bound));
}

}  // namespace frond::stability
