#include "leaf/solve/solver.h"

#include "leaf/solve/chain.h"
#include "leaf/solve/depth_solver.h"

namespace frond::leaf {
namespace {

std::vector<std::vector<Shares>> solve_chain(const Chain& chain, std::span<const Tissue> tissues,
                                             std::span<const double> theta_deg, int places) {
  const DepthSolver solver(chain, theta_deg);
  std::vector<std::vector<Shares>> result;
  for (const Tissue& tissue : tissues) result.push_back(solver.solve(tissue, places));
  return result;
}

}  // namespace

int solver_nodes(const Tissue& tissue) {
  const auto [least, most] = exponents_inside(tissue);
  constexpr double kSmooth = 1, kNarrow = 20;
  return least >= kSmooth && most <= kNarrow ? 6 : 12;
}

std::vector<Shares> solve(const Tissue& tissue, std::span<const double> theta_deg, int nodes) {
  const Chain chain(tissue, nodes, 1);
  return DepthSolver(chain, theta_deg).solve(tissue, 2 * nodes);
}

std::vector<Shares> solve(const Tissue& tissue, std::span<const double> theta_deg) {
  return solve(tissue, theta_deg, solver_nodes(tissue));
}

std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg) {
  return solve_depths(tissues, theta_deg, solver_nodes(tissues[0]));
}

std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg,
                                              int nodes) {
  return solve_chain(Chain(tissues[0], nodes, 1), tissues, theta_deg, 2 * nodes);
}

std::vector<std::vector<Shares>> solve_depths(std::span<const Tissue> tissues, std::span<const double> theta_deg,
                                              const NodeRule& rule, LobeMeans& means) {
  return solve_chain(Chain(tissues[0], rule, 1, &means), tissues, theta_deg, 2 * rule.nodes);
}

}  // namespace frond::leaf
