#include "core/shape.h"

// Instances of an object by the million.

namespace frond {
namespace {

constexpr Param kInstances[] = {{.name = "object",
                                 .kind = ParamKind::string,
                                 .doc = "The name of the object that is copied (ObjectBegin).",
                                 .required = true},
                                {.name = "filename",
                                 .kind = ParamKind::string,
                                 .doc = "Table of the instances: a NumPy file (.npy), a row for each, of \"transform\" "
                                        "(the three rows of a matrix) and any other numbers, all of them float32.",
                                 .required = true}};

MadeShape make_instances(const Params& p, const ShapePlacement&) {
  return ObjectInstances{.object = p.string("object"), .table = p.file("filename")};
}

}  // namespace

extern const ShapeInfo instances_shape{
    {"shape", "instances", "Instances of an object, a row of a table for each.", "", kInstances}, make_instances};

}  // namespace frond
