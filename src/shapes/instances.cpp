#include "core/shape.h"

// Shape "instances": instances of an object from a table with millions of rows.

namespace frond {
namespace {

constexpr Param kInstances[] = {
    {.name = "object",
     .kind = ParamKind::string,
     .doc = "Name of the object to place (ObjectBegin).",
     .required = true},
    {.name = "filename",
     .kind = ParamKind::string,
     .doc = "Instance table: a NumPy file (.npy) with one row for each instance: \"transform\" "
            "(the three rows of a matrix) and any other numbers, all of them float32; \"transform\" may be float64.",
     .required = true}};

/// Returns the names of object and table; the scene reads the table.
MadeShape make_instances(const Params& p, const ShapePlacement&) {
  return ObjectInstances{.object = p.string("object"), .table = p.file("filename")};
}

}  // namespace

extern const ShapeInfo instances_shape{
    {"shape", "instances", "Instances of an object, from a table with one row for each.", "", kInstances},
    make_instances};

}  // namespace frond
