#pragma once

#include <map>
#include <optional>
#include <utility>

#include "exports/mitsuba/materials.h"
#include "scene/geometry/instance_table.h"

namespace frond::mitsuba {

/// Makes the shapes of a scene and writes them. Meshes become PLY files in the space of their object; whole spheres,
/// disks and cylinders become Mitsuba's; instances of objects become instances of shape groups, without nesting.
class Shapes {
 public:
  /// Makes all shapes. Throws InputError.
  Shapes(Context& context, Materials& materials);

  /// Bounding box of the scene, in frond's units.
  const Bounds& bounds() const { return bounds_; }
  /// Writes the materials that the shapes have.
  void write_materials(Xml& xml);
  /// Writes all shapes, with their area lights.
  void write(Xml& xml);

 private:
  struct Surface {
    const ShapeDescription* shape;
    ShapeGeometry geometry;
  };
  struct Placed {
    size_t object;  ///< index in the description
    AffineMap map;
  };
  struct Parts {
    std::vector<Surface> surfaces;
    Bounds bounds;  ///< of the surfaces
    std::vector<Placed> instances;
  };

  Parts parts_of(const std::vector<ShapeDescription>& shapes, const InstanceList& instances);
  void add(const ShapeDescription& shape, Parts& parts);
  static std::optional<std::pair<Location, std::string>> unsupported_reason(const ShapeDescription& shape,
                                                                            const Params& p);
  void add_table(const ObjectInstances& set, const ShapeDescription& shape, const Params& p, Parts& parts);
  void place(const Placed& placed, const AffineMap& world, size_t depth);
  void write_surface(Xml& xml, const Surface& surface, bool is_in_world);
  void write_mesh(Xml& xml, const Surface& surface, const TriangleMesh& mesh, bool is_in_world);
  void write_quadric(Xml& xml, const Surface& surface, bool is_in_world);
  void write_appearance(Xml& xml, const Surface& surface);
  void write_area_light(Xml& xml, const ShapeDescription& shape);

  Context& context_;
  Materials& materials_;
  Parts world_;
  std::vector<Parts> objects_;
  std::vector<Placed> placed_;  ///< instances in the world, without nesting
  Bounds bounds_;
};

/// Returns the transform as rows in double precision.
Transform::RowsDouble rows_of(const AffineMap& map);
/// Returns `rows` after a scaling by `units`.
Transform::RowsDouble in_units(Transform::RowsDouble rows, double units);

}  // namespace frond::mitsuba
