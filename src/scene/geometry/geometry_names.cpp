#include "scene/geometry/geometry_object.h"

namespace frond {
namespace {

/// Traverses the instances in the order of their numbers.
class Names {
 public:
  /// `first`: number of the object's own surfaces; contained instances follow.
  void visit(const GeometryObject& object, uint64_t first) {
    if (first > 0 && !object.parts.surfaces.empty()) add(first, object.parts.name);
    for (const GeometryInstances& set : object.instances) {
      const bool is_one_name = set.objects.size() == 1 && set.objects[0]->instances.empty();
      const size_t rows = is_one_name ? std::min<size_t>(set.instances.table->size(), 1) : set.instances.table->size();
      for (size_t row = 0; row < rows && names.size() < kMost; ++row)
        visit(set.object(row), first + (set.ids.empty() ? set.first_id + row * set.object(row).ids : set.ids[row]));
    }
  }
  std::vector<std::pair<uint64_t, std::string>> names;

 private:
  /// A list in memory and in parts of images; beyond it, instances of huge scenes share the name "instance".
  static constexpr size_t kMost = 1 << 18;

  void add(uint64_t first, const std::string& name) {
    const std::string& known = names.size() + 1 == kMost || name.empty() ? kNoName : name;
    if (names.empty() || names.back().second != known) names.emplace_back(first, known);
  }
  const std::string kNoName = "instance";
};

}  // namespace

std::vector<std::pair<uint64_t, std::string>> Geometry::instance_names() const {
  Names names;
  names.visit(*world_, 0);
  return std::move(names.names);
}

}  // namespace frond
