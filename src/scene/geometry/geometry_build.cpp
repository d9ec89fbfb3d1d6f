#include <algorithm>
#include <cassert>

#include "core/error.h"
#include "core/stop.h"
#include "scene/geometry/embree_instances.h"
#include "scene/geometry/embree_surfaces.h"
#include "scene/geometry/geometry.h"
#include "scene/geometry/outline.h"

// Building the Embree scenes of a Geometry.

namespace frond {
namespace {

/// Whether each mesh becomes a separate Embree scene. Embree builds one tree of triangles and another one of all other
/// geometry, and each ray visits both; a ground or a wall takes less time as an element of the second tree
/// (docs/internals.md, "Instances").
bool has_small_meshes_beside_others(const ObjectParts& parts) {
  constexpr size_t kMostTriangles = 64;
  size_t meshes = 0, triangles = 0;
  for (const Surface& surface : parts.surfaces)
    if (const auto* mesh = std::get_if<MeshPtr>(&surface.geometry)) {
      ++meshes;
      triangles += (*mesh)->triangles.size();
    }
  return triangles <= kMostTriangles && (meshes < parts.surfaces.size() || !parts.instances.empty());
}

/// Embree's progress callback: Embree cancels the build if it returns false.
bool continue_build(void* stop, double /*share*/) { return !static_cast<const StopState*>(stop)->is_requested(); }

}  // namespace

void embree::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void embree::Release::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

/// Objects are built in order, because instances refer to earlier objects.
Geometry::Geometry(std::vector<ObjectParts> objects, ObjectParts world, int threads) {
  // AVX-512 is not faster for single rays, and changes the last bits of hits.
  device_.reset(rtcNewDevice(fmt::format("max_isa=avx2,threads={}", threads).c_str()));
  if (!device_) fail({}, "Embree cannot start: error {}", int(rtcGetDeviceError(nullptr)));
  for (ObjectParts& parts : objects) {
    const uint64_t first_id = parts.surfaces.empty() ? 0 : 1;
    objects_.push_back(build(std::move(parts), first_id));
  }
  world_ = build(std::move(world), 1);
  assert(world_->depth <= InstanceRows::kMost);
}

/// Embree reports errors through the device, not by return values.
void Geometry::check() const {
  const RTCError error = rtcGetDeviceError(device_.get());
  if (error == RTC_ERROR_CANCELLED) throw Stopped();
  if (error != RTC_ERROR_NONE)
    fail({}, "Embree cannot build the scene: {}",
         error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : fmt::format("error {}", int(error)));
}

embree::Scene Geometry::new_scene() const {
  embree::Scene scene(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);  // avoids missed hits between adjacent triangles
  return scene;
}

/// Builds one object's Embree scene. `first_id` is 1 if the object has surfaces of its own.
std::unique_ptr<GeometryObject> Geometry::build(ObjectParts parts, uint64_t first_id) {
  auto object = std::make_unique<GeometryObject>(GeometryObject{.parts = std::move(parts)});
  if (!object->parts.instances.empty()) object->ids = first_id;
  object->scene = new_scene();
  RTCScene scene = object->scene.get();
  attach(*object);
  StopState stop = current_stop();  // Embree builds in threads of its own
  rtcSetSceneProgressMonitorFunction(scene, continue_build, &stop);
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  check();
  object->bounds = widened(embree::bounds_of(scene));
  object->outline = outline_of(object->parts, embree::bounds_of(scene));
  const auto& surfaces = object->parts.surfaces;
  if (object->instances.empty() && surfaces.size() == 1)
    if (const auto* shape = std::get_if<AnalyticShapePtr>(&surfaces[0].geometry); shape && (*shape)->count() == 1)
      object->only_primitive = &surfaces[0];
  return object;
}

/// Attaches surfaces first, then instances, so that an Embree geometry ID below the number of surfaces is a surface.
void Geometry::attach(GeometryObject& object) {
  unsigned id = 0;
  const auto add = [&](RTCGeometry geometry) {
    rtcAttachGeometryByID(object.scene.get(), geometry, id++);
    rtcReleaseGeometry(geometry);
  };
  const bool nests = has_small_meshes_beside_others(object.parts);
  for (const Surface& surface : object.parts.surfaces) {
    RTCGeometry geometry = embree::new_geometry(device_.get(), surface);
    if (nests && std::holds_alternative<MeshPtr>(surface.geometry)) {
      RTCScene inner = object.small_meshes.emplace_back(new_scene()).get();
      rtcAttachGeometryByID(inner, geometry, id);
      rtcReleaseGeometry(geometry);
      rtcCommitScene(inner);
      geometry = embree::new_geometry(device_.get(), inner);
    }
    add(geometry);
  }
  if (object.parts.instances.empty()) return;
  for (const Instances& instances : object.parts.instances) {
    GeometryInstances set{.instances = instances, .objects = {}, .first_id = object.ids};
    for (const uint32_t place : instances.objects) set.objects.push_back(objects_[place].get());
    const size_t rows = instances.table->size();
    if (rows <= GeometryInstances::kMostKept && instances.motions.empty()) {
      set.inverses.reserve(rows);
      for (size_t row = 0; row < rows; ++row) {
        if (row % 65536 == 0) check_stop();
        set.inverses.push_back(instances.table->map(row).inverse());
      }
    }
    if (instances.is_placed) set.from_placement = instances.placement.inverse();
    const auto as_many = [&](const GeometryObject* o) { return o->ids == set.objects.front()->ids; };
    if (rows == 0 || std::ranges::all_of(set.objects, as_many)) {
      object.ids += rows == 0 ? 0 : rows * set.objects.front()->ids;
    } else {
      for (size_t row = 0; row < rows; ++row) {
        set.ids.push_back(object.ids);
        object.ids += set.object(row).ids;
      }
    }
    float into = instances.table->inverse_stretch() * (instances.is_placed ? set.from_placement.largest_stretch() : 1);
    for (const Motion& motion : instances.motions)  // the table holds the starts
      into = std::max(into, motion.at(1).inverse().largest_stretch());
    for (const GeometryObject* o : set.objects) {
      object.depth = std::max(object.depth, o->depth + 1);
      object.stretch = std::max(object.stretch, into * o->stretch);
    }
    object.instances.push_back(std::move(set));
  }
  for (const GeometryInstances& set : object.instances) add(embree::new_geometry(device_.get(), set));
}

}  // namespace frond
