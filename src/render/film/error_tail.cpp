#include "render/film/error_tail.h"

#include <algorithm>
#include <functional>
#include <numeric>

namespace frond {

ErrorTail error_tail(const Film& film) {
  constexpr size_t kLeast = 10000;
  const Crop& crop = film.settings().crop;
  const size_t count = size_t(crop.width()) * size_t(crop.height());
  if (!film.format().has_colors() || count < kLeast) return {};
  std::vector<double> variances;
  variances.reserve(count);
  for (int y = crop.y0; y < crop.y1; ++y)
    for (int x = crop.x0; x < crop.x1; ++x) {
      const auto v = film.variance(x, y);
      variances.push_back(v[0] + v[1] + v[2]);
    }
  const double all = std::accumulate(variances.begin(), variances.end(), 0.0);
  if (!(all > 0)) return {};
  const auto worst = variances.begin() + static_cast<ptrdiff_t>(double(count) * ErrorTail::kWorst);
  std::nth_element(variances.begin(), worst, variances.end(), std::greater<>());
  return {std::accumulate(variances.begin(), worst, 0.0) / all};
}

}  // namespace frond
