#include "leaf/tissue/prospect.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <vector>

#include "core/math/random.h"
#include "leaf/tissue/absorption.h"

namespace frond::leaf {
namespace {

/// Step of the walk's constants in nodes of the file: leaf tables have steps of 2.5 nm, absorption has 5 nm.
constexpr size_t kStep = 5;
constexpr WavelengthGrid kCoarse{400, 5, 421};

using ProspectRow = std::array<double, 8>;  ///< columns of the file

ProspectRow row_of(std::string_view line) {
  ProspectRow row{};
  const char* at = line.data();
  for (double& x : row) {
    const auto [end, error] = std::from_chars(at, line.data() + line.size(), x);
    assert(error == std::errc());
    at = end + 1;  // past the comma
  }
  return row;
}

std::vector<ProspectNode> read() {
  std::vector<ProspectNode> nodes;
  for (size_t begin = 0; begin < prospect_csv.size();) {
    const size_t end = std::min(prospect_csv.find('\n', begin), prospect_csv.size());
    const std::string_view line = prospect_csv.substr(begin, end - begin);
    begin = end + 1;
    if (line.empty() || line[0] < '0' || line[0] > '9') continue;  // a comment or the names
    const auto [nm, chlorophyll, carotenoids, anthocyanins, water, dry_matter, brown, index] = row_of(line);
    nodes.push_back({nm, {chlorophyll, carotenoids, anthocyanins, water, dry_matter, brown}, index});
  }
  assert(nodes.size() == kCoarse.size() * kStep - kStep + 1);
  return nodes;
}

/// Every kStep-th node, without the plateau of dry matter.
std::vector<ProspectConstants> coarse_constants() {
  std::vector<ProspectConstants> nodes;
  for (size_t i = 0; i < prospect_nodes().size(); i += kStep) nodes.push_back(prospect_nodes()[i].specific);
  const double plateau = std::ranges::min(nodes, {}, &ProspectConstants::dry_matter).dry_matter;
  for (ProspectConstants& c : nodes) c.dry_matter -= plateau;
  return nodes;
}

}  // namespace

std::span<const ProspectNode> prospect_nodes() {
  static const std::vector<ProspectNode> nodes = read();
  return nodes;
}

ProspectConstants prospect_constants_at(double lambda_nm) {
  static const std::vector<ProspectConstants> nodes = coarse_constants();
  const auto [i, t] = kCoarse.cell(lambda_nm);
  const ProspectConstants &a = nodes[i], &b = nodes[i + 1];
  const auto between = [t = t](double x, double y) { return (1 - t) * x + t * y; };
  return {between(a.chlorophyll, b.chlorophyll),   between(a.carotenoids, b.carotenoids),
          between(a.anthocyanins, b.anthocyanins), between(a.water, b.water),
          between(a.dry_matter, b.dry_matter),     between(a.brown_pigments, b.brown_pigments)};
}

uint64_t prospect_hash() {
  uint64_t key = 0;
  for (const char c : prospect_csv) key = hash_key(key, static_cast<uint64_t>(c));
  return key;
}

}  // namespace frond::leaf
