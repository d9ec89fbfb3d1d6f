// Reflectance and transmittance of a leaf file: leaf_albedo FILE LAMBDA_NM THETA_DEG [DEPTH] With "-" for the angle it
// reads pairs of directions, six numbers a line, and prints f for each.
#include <cstdio>
#include <iostream>
#include <random>

#include "frond_leaf.h"

int main(int argc, char** argv) try {
  if (argc < 4) return std::fprintf(stderr, "usage: leaf_albedo FILE LAMBDA_NM THETA_DEG|- [DEPTH]\n"), 1;
  const frond::Leaf leaf(argv[1]);
  const frond::Leaf::At at = leaf.at(std::stod(argv[2]), argc > 4 ? std::stod(argv[4]) : 0);
  if (std::string(argv[3]) == "-") {
    frond::Leaf::Direction i, o;
    while (std::cin >> i.x >> i.y >> i.z >> o.x >> o.y >> o.z)
      std::printf("%.9g %.9g\n", leaf.f(at, i, o), leaf.pdf(at, i, o));
    return 0;
  }
  const double theta = std::stod(argv[3]) * 3.141592653589793 / 180;
  const frond::Leaf::Direction incident{std::sin(theta), 0, std::cos(theta)};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  const int count = 1000000;
  double reflected = 0, transmitted = 0;
  for (int i = 0; i < count; ++i) {
    const auto s = leaf.sample(at, incident, u(random), u(random), u(random));
    (s.leaving.z * incident.z > 0 ? reflected : transmitted) += s.weight;
  }
  std::printf("R %.5f T %.5f\n", reflected / count, transmitted / count);
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "leaf_albedo: %s\n", error.what()), 1;
}
