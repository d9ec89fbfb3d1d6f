#include "leaf/fit/fit_search.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <mutex>

#include "leaf/fit/bare_leaf.h"
#include "leaf/solve/lobe_mean.h"
#include "leaf/solve/solver.h"

namespace frond::leaf {

using Eigen::Index;
using Eigen::VectorXd;
using Pair = OpticsSurface::Pair;

/// Surfaces by all that decides them.
struct FitCache::Content {
  std::mutex mutex;
  std::map<std::vector<double>, std::shared_ptr<const OpticsSurface>> known;
};

FitCache::FitCache() : content_(std::make_unique<Content>()) {}
FitCache::~FitCache() = default;

namespace {

/// Structures at which a search starts.
using Start = std::array<double, 4>;
constexpr double TissueParams::*kStarted[] = {&TissueParams::epidermis_aspect, &TissueParams::spongy_aspect,
                                              &TissueParams::palisade_aspect, &TissueParams::spongy_share};
constexpr Start kStarts[] = {{5, 5, 1, 0.05}, {2, 2, 1, 0.3}, {12, 8, 4, 0.15}, {3, 5, 2, 0.2}};

/// Rows in the search, before its end.
constexpr size_t kSearchRows = 110;

/// A kind of leaf (structure, sieve) and the best leaf of it so far.
struct Candidate {
  std::unique_ptr<LeafSpace> space;
  std::unique_ptr<FitRows> rows;
  std::unique_ptr<FitProblem> problem;
  VectorXd logs;
  double cost = HUGE_VAL;
  SurfaceExpansion expansion;
};

TissueParams start_params(const LeafSpace& space, const Start& start) {
  TissueParams p = space.origin();
  for (const LeafNumber* v : space.free())
    for (size_t i = 0; i < start.size(); ++i)
      if (v->member == kStarted[i]) v->value(p) = start[i];
  return p;
}

/// Makes surfaces for a search.
class Surfaces {
 public:
  Surfaces(const std::vector<double>& theta_deg, FitCache::Content& cache) : theta_deg_(theta_deg), cache_(cache) {}

  OpticsSurface search(const TissueParams& p) { return {p, theta_deg_, kSearchNodes, means_}; }
  OpticsSurface even(const TissueParams& p) { return {p, theta_deg_, kEvenNodes, means_}; }
  OpticsSurface fine(const TissueParams& p) { return {p, theta_deg_, kFitNodes, means_}; }
  /// `search` for a structure that many searches need. The result is the same whether it was known or not.
  std::shared_ptr<const OpticsSurface> shared(const TissueParams& p) {
    std::vector<double> key{static_cast<double>(p.structure), p.sieve_and_detour ? 1.0 : 0.0};
    for (const LeafNumber& n : kLeafNumbers)
      if (n.is_structure()) key.push_back(n.value(p));
    key.insert(key.end(), theta_deg_.begin(), theta_deg_.end());
    {
      const std::lock_guard lock(cache_.mutex);
      if (const auto found = cache_.known.find(key); found != cache_.known.end()) return found->second;
    }
    auto made = std::make_shared<const OpticsSurface>(search(p));
    const std::lock_guard lock(cache_.mutex);
    return cache_.known.emplace(key, std::move(made)).first->second;
  }

  /// Differences by each free structural parameter, of surfaces that are all solved with one rule.
  using Solve = std::function<OpticsSurface(const TissueParams&)>;
  static std::vector<OpticsSurface> slopes(const LeafSpace& space, const VectorXd& logs, double step,
                                           const Solve& solve) {
    const OpticsSurface base = solve(space.at(logs));
    std::vector<OpticsSurface> result;
    for (Index i = 0; i < space.count(); ++i) {
      if (!space.variable(i).is_structure()) continue;
      VectorXd moved = logs;
      const double change = logs[i] + step <= space.high(i) ? step : -step;
      moved[i] += change;
      OpticsSurface& slope = result.emplace_back(solve(space.at(moved)));
      slope.add(-1, base);
      slope.scale(1 / change);
    }
    return result;
  }
  std::vector<OpticsSurface> search_slopes(const LeafSpace& space, const VectorXd& logs) {
    return slopes(space, logs, kSearchStep, [this](const TissueParams& p) { return search(p); });
  }
  std::vector<OpticsSurface> shared_slopes(const LeafSpace& space, const VectorXd& logs) {
    return slopes(space, logs, kSearchStep, [this](const TissueParams& p) { return *shared(p); });
  }
  /// The same with as many nodes for every structure, so that they do not change where the indices move a limit.
  std::vector<OpticsSurface> even_slopes(const LeafSpace& space, const VectorXd& logs) {
    constexpr double kStep = 0.05;
    return slopes(space, logs, kStep, [this](const TissueParams& p) { return even(p); });
  }

 private:
  static constexpr NodeRule kSearchNodes{.nodes = 3, .by_flux = true}, kEvenNodes{.nodes = 3};
  static constexpr double kSearchStep = 0.1;

  const std::vector<double>& theta_deg_;
  FitCache::Content& cache_;
  LobeMeans means_;
};

/// The best leaf of each kind with only its chemistry free, the best one first.
std::vector<Candidate> first_candidates(const FitRequest& request, const FitRows& all, Surfaces& surfaces) {
  std::vector<Candidate> best;
  for (const Structure structure : {Structure::bifacial, Structure::unifacial}) {
    if (request.structure && *request.structure != structure) continue;
    for (const bool sieve : {false, true}) {
      if (request.sieve && *request.sieve != sieve) continue;
      Candidate c;
      c.space = std::make_unique<LeafSpace>(request, structure, sieve);
      c.rows = std::make_unique<FitRows>(all.thinned(kSearchRows));
      c.problem = std::make_unique<FitProblem>(request, *c.space, *c.rows);
      for (const Start& start : kStarts) {
        VectorXd logs = c.space->logs_of(start_params(*c.space, start));
        SurfaceExpansion expansion{logs, *surfaces.shared(c.space->at(logs)), {}, {}};
        const double cost =
            c.problem->minimise(expansion, {.structure_is_free = false, .most_steps = 30, .done = 1e-3}, logs);
        if (cost < c.cost) c.cost = cost, c.logs = logs, c.expansion = std::move(expansion);
      }
      c.expansion.slopes = surfaces.shared_slopes(*c.space, c.expansion.at);
      best.push_back(std::move(c));
    }
  }
  std::ranges::sort(best, {}, &Candidate::cost);
  return best;
}

/// Broyden's update: corrects the slopes by the result of a step.
void broyden_update(const FitProblem& problem, const VectorXd& step, const OpticsSurface& found,
                    const OpticsSurface& expected, SurfaceExpansion& expansion) {
  double square = 0;
  for (const Index i : problem.structural()) square += step[i] * step[i];
  if (square == 0) return;
  for (size_t k = 0; k < expansion.slopes.size(); ++k) {
    const double share = step[problem.structural()[k]] / square;
    expansion.slopes[k].add(share, found), expansion.slopes[k].add(-share, expected);
  }
}

double largest_step(const FitProblem& problem, const VectorXd& step) {
  double largest = 0;
  for (const Index i : problem.structural()) largest = std::max(largest, std::abs(step[i]));
  return largest;
}

/// Frees the structure: alternates between a search in the expansion and the surface of the structure found.
/// `done`: relative change of the sum of squares at which the search ends.
void refine(Candidate& c, Surfaces& surfaces, int rounds, double done) {
  constexpr double kLargest = 1.5, kSmallest = 0.02;
  double radius = 0.7;
  bool is_fresh = true;
  for (int round = 0; round < rounds; ++round) {
    VectorXd logs = c.logs;
    c.problem->minimise(c.expansion, {.structure_is_free = true, .radius = radius, .most_steps = 20, .done = 1e-5},
                        logs);
    const VectorXd step = logs - c.logs;
    const OpticsSurface expected = c.problem->surface(c.expansion, logs);
    SurfaceExpansion there{logs, surfaces.search(c.space->at(logs)), {}, {}};
    // The chemistry of the new structure's own surface.
    const double cost = c.problem->minimise(there, {.structure_is_free = false, .most_steps = 6, .done = 1e-3}, logs);
    broyden_update(*c.problem, step, there.base, expected, c.expansion);
    const double moved = largest_step(*c.problem, step), gain = (c.cost - cost) / c.cost;
    if (cost < c.cost) {
      if (moved > 0.9 * radius) radius = std::min(kLargest, 2 * radius);
      c.cost = cost, c.logs = logs;
      c.expansion.at = logs, c.expansion.base = std::move(there.base);
    } else {
      radius = moved / 3;
    }
    if (gain < done || radius < kSmallest) {
      if (is_fresh && (gain >= 0 || radius < kSmallest)) break;
      if (!is_fresh) {
        c.expansion.slopes = surfaces.search_slopes(*c.space, c.logs);
        is_fresh = true, radius = std::max(radius, 0.1);
        continue;
      }
    }
    is_fresh = false;
  }
}

/// Continues with all rows and accurate surfaces.
void polish(Candidate& c, const FitProblem& problem, Surfaces& surfaces) {
  constexpr int kRounds = 12;
  constexpr double kDone = 1e-4, kRadius = 0.5;
  c.expansion.base = surfaces.fine(c.space->at(c.logs)), c.expansion.slopes = surfaces.even_slopes(*c.space, c.logs);
  c.cost = problem.cost(c.expansion, c.logs);
  for (int round = 0; round < kRounds; ++round) {
    VectorXd logs = c.logs;
    problem.minimise(c.expansion, {.structure_is_free = true, .radius = kRadius, .most_steps = 20, .done = 1e-5}, logs);
    SurfaceExpansion there{logs, surfaces.fine(c.space->at(logs)), {}, {}};
    const double cost = problem.minimise(there, {.structure_is_free = false, .most_steps = 6, .done = 1e-5}, logs);
    broyden_update(problem, logs - c.logs, there.base, problem.surface(c.expansion, logs), c.expansion);
    const double gain = (c.cost - cost) / c.cost;
    if (gain > 0) {
      c.cost = cost, c.logs = logs;
      c.expansion.at = logs, c.expansion.base = std::move(there.base);
    }
    if (gain < kDone) break;
  }
}

/// Last steps of a search: solves R and T at the measurements and adds their difference from the surface to it, until
/// the fit no longer changes.
FoundLeaf finish(Candidate& c, const FitProblem& problem, const FitRows& rows, Surfaces& surfaces,
                 const ThreadPool& pool) {
  constexpr int kRounds = 4;
  constexpr double kDone = 1e-3, kRadius = 0.2;
  std::vector<Pair> solved = solve_rows(rows, c.space->at(c.logs), pool);
  c.cost = problem.cost(solved, c.logs);
  for (int round = 0; round < kRounds; ++round) {
    c.expansion.corrections = problem.values(c.expansion, c.logs);
    for (size_t i = 0; i < solved.size(); ++i) {
      Pair& correction = c.expansion.corrections[i];
      correction = {solved[i].r - correction.r, solved[i].t - correction.t};
    }
    VectorXd logs = c.logs;
    const double expected = problem.minimise(
        c.expansion, {.structure_is_free = true, .radius = kRadius, .most_steps = 20, .done = 1e-5}, logs);
    if (c.cost - expected < kDone * c.cost) break;
    std::vector<Pair> there = solve_rows(rows, c.space->at(logs), pool);
    const double cost = problem.cost(there, logs);
    if (!(cost < c.cost)) break;
    c.cost = cost, c.logs = logs, solved = std::move(there);
  }
  // Slopes by Broyden's update are accurate enough for the search, but not for the errors of the parameters.
  c.expansion.slopes = surfaces.even_slopes(*c.space, c.logs);
  return {std::move(c.space), c.logs, std::move(solved), std::move(c.expansion)};
}

}  // namespace

std::vector<Pair> solve_rows(const FitRows& rows, const TissueParams& params, const ThreadPool& pool) {
  const BareLeaf leaf(params);
  const Constituents amounts = amounts_of(params);
  LobeMeans made;
  for (const double exponent : {params.epidermis_aspect, params.spongy_aspect, params.palisade_aspect})
    made.get(exponent);
  const std::vector<size_t> chosen = rows.spread(kMostSolvedRows);
  std::vector<Pair> solved(chosen.size());
  constexpr size_t kChunk = 16;
  const size_t chunks = (chosen.size() + kChunk - 1) / kChunk;
  pool.for_each(static_cast<int64_t>(chunks), [&](int64_t chunk, int) {
    LobeMeans means = made;
    const size_t first = static_cast<size_t>(chunk) * kChunk, end = std::min(first + kChunk, chosen.size());
    for (size_t i = first; i < end; ++i) {
      const FitRow& row = rows.rows[chosen[i]];
      const Tissue tissue = leaf.at(row.lambda_nm, depth_of(amounts, row.specific));
      const Shares s = solve_depths({&tissue, 1}, {&rows.theta_deg[row.angle], 1}, kFitNodes, means)[0][0];
      solved[i] = {s.surface + s.subsurface, s.transmitted};
    }
  });
  if (chosen.size() == rows.rows.size()) {
    std::vector<Pair> result(solved.size());
    for (size_t i = 0; i < chosen.size(); ++i) result[chosen[i]] = solved[i];
    return result;
  }
  const OpticsSurface surface(params, rows.theta_deg, kFitNodes, made);
  return rows.filled(chosen, solved, surface, amounts);
}

FoundLeaf search_leaf(const FitRequest& request, const FitRows& rows, const ThreadPool& pool, FitCache& cache) {
  constexpr size_t kKept = 2;  // kinds of leaves that continue
  Surfaces surfaces(rows.theta_deg, cache.content());
  std::vector<Candidate> candidates = first_candidates(request, rows, surfaces);
  for (Candidate& c : candidates) refine(c, surfaces, 3, 1e-2);
  std::ranges::sort(candidates, {}, &Candidate::cost);
  candidates.resize(std::min(candidates.size(), kKept));
  for (Candidate& c : candidates) refine(c, surfaces, 15, 1e-3);
  std::ranges::sort(candidates, {}, &Candidate::cost);
  // The surfaces of the search do not decide between kinds that are almost equally good.
  constexpr double kAlmost = 1.5;
  while (candidates.back().cost > kAlmost * candidates.front().cost) candidates.pop_back();
  for (Candidate& c : candidates) polish(c, FitProblem(request, *c.space, rows), surfaces);
  Candidate& best = *std::ranges::min_element(candidates, {}, &Candidate::cost);
  return finish(best, FitProblem(request, *best.space, rows), rows, surfaces, pool);
}

}  // namespace frond::leaf
