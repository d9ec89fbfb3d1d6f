// Rays that leave a plane must not hit it again, at any position and under any nesting of instances.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/log.h"
#include "integrators/registry.h"
#include "materials/registry.h"
#include "scene/format/parser.h"
#include "scene/scene.h"
#include "scene/scene_options.h"
#include "tests/support/slow.h"

namespace frond {
namespace {

/// A scene of a text, in wavelengths that every material has.
class TextScene {
 public:
  explicit TextScene(const std::string& world) : scene_(description(world), registry_, pool_, silent_log()) {}
  const World& world() const { return scene_; }
  /// A point of the text's world in the rendered one, whose origin is among the shapes if these are far away.
  Vec3 rendered(const Vec3d& p) const { return to_float(p - scene_.origin()); }

 private:
  static SceneDescription description(const std::string& world) {
    SceneDescription d = parse_scene_text("WorldBegin\nLightSource \"infinite\"\n" + world, "s", silent_log());
    set_wavelengths(d, "smpte");
    return d;
  }

  ThreadPool pool_{1};
  Registry registry_ = make_registry(builtin_materials(), builtin_integrators());
  Scene scene_;
};

/// Random planes, or closed boxes: meshes of few triangles, in objects that are placed in up to three levels.
class RandomMesh {
 public:
  enum class Form { plane, box };

  RandomMesh(Form form, unsigned seed) : random_(seed) {
    half_ = {size(1e-2, 1e4), 0};
    half_.y = half_.x * (chance(0.5) ? 1 : size(1e-3, 1));
    height_ = chance(0.5) ? 0 : sign() * size(1e-3, 1e3);
    const std::string baked = chance(0.5) ? "" : any_transform();
    const std::string shape = baked + (form == Form::box ? box() : mesh(int(pick(4)) + 1));
    const uint64_t levels = pick(4);
    std::string inner = shape;
    for (uint64_t i = 0; i < levels; ++i) {
      text += fmt::format("AttributeBegin\nObjectBegin \"{}\"\n{}ObjectEnd\nAttributeEnd\n", i, inner);
      inner = any_transform() + fmt::format("ObjectInstance \"{}\"\n", i);
    }
    text += inner;
  }

  /// A random point of the plane in the world, and its normal with an arbitrary sign.
  std::pair<Vec3d, Vec3d> point() {
    const double x = (2 * uniform() - 1) * double(half_.x), y = (2 * uniform() - 1) * double(half_.y);
    Vec3d p{x, y, height_}, s{1, 0, 0}, t{0, 1, 0};
    for (const Step& step : steps_) p = step.vector(p) + step.translation, s = step.vector(s), t = step.vector(t);
    return {p, normalize(cross(s, t))};
  }
  Vec3d middle() {
    Vec3d p{0, 0, height_};
    for (const Step& step : steps_) p = step.vector(p) + step.translation;
    return p;
  }
  double distance() { return size(1e-2, 10) * double(half_.x); }
  /// A direction on the side of `n`, also a grazing one.
  Vec3d direction(const Vec3d& n) {
    const double cosine = chance(0.5) ? uniform() : size(1e-3, 1), phi = 2 * M_PI * uniform();
    const double sine = std::sqrt(1 - cosine * cosine);
    return Framed::around(n).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
  }

  std::string text;

 private:
  /// Columns and translation of a map.
  struct Step {
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, translation{};
    Vec3d vector(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
  };

  double uniform() { return std::uniform_real_distribution<double>()(random_); }
  bool chance(double share) { return uniform() < share; }
  uint64_t pick(uint64_t count) { return random_() % count; }
  double sign() { return chance(0.5) ? 1 : -1; }
  double size(double least, double most) { return least * std::pow(most / least, uniform()); }

  std::string mesh(int across) {
    std::string p, indices;
    for (int j = 0; j <= across; ++j)
      for (int i = 0; i <= across; ++i)
        p += fmt::format("{} {} {}  ", half_.x * (2.0 * i / across - 1), half_.y * (2.0 * j / across - 1), height_);
    const int row = across + 1;
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) {
        const int a = j * row + i;
        indices += fmt::format("{} {} {} {} {} {} ", a, a + 1, a + row + 1, a, a + row + 1, a + row);
      }
    return fmt::format("Shape \"trianglemesh\" \"point3 P\" [{}] \"integer indices\" [{}]\n", p, indices);
  }

  Step rotation() {
    const double angle = chance(0.3) ? M_PI / 2 * double(pick(4)) : 2 * M_PI * uniform();
    const double c = std::cos(angle), s = std::sin(angle);
    const uint64_t axis = pick(4);
    if (axis == 0) return {{1, 0, 0}, {0, c, s}, {0, -s, c}, {}};
    if (axis == 1) return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}, {}};
    if (axis == 2) return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}, {}};
    const double z = 2 * uniform() - 1, r = std::sqrt(1 - z * z), phi = 2 * M_PI * uniform();
    const Framed f = Framed::around({r * std::cos(phi), r * std::sin(phi), z});
    return {f.x * c + f.y * s, f.y * c - f.x * s, f.z, {}};
  }

  /// Corners at all signs of half_ and of a depth, above height_.
  std::string box() {
    const double depth = half_.x * size(1e-2, 1);
    std::string p;
    for (int i = 0; i < 8; ++i)
      p += fmt::format("{} {} {}  ", half_.x * (i & 1 ? 1 : -1), half_.y * (i & 2 ? 1 : -1),
                       height_ + (i & 4 ? depth : -depth));
    return fmt::format(
        "Shape \"trianglemesh\" \"point3 P\" [{}] \"integer indices\" [0 2 3 0 3 1  4 5 7 4 7 6  0 1 5 0 5 4  "
        "2 6 7 2 7 3  0 4 6 0 6 2  1 3 7 1 7 5]\n",
        p);
  }

  /// Writes a transform, and composes it with those inside.
  std::string any_transform() {
    Step step = chance(0.8) ? rotation() : Step{};
    const uint64_t scale = pick(3);
    const double all = scale == 0 ? 1 : size(1e-2, 1e2);
    const auto one = [&] { return scale == 2 ? all * size(0.1, 10) : all; };
    step.x = step.x * one(), step.y = step.y * one(), step.z = step.z * one();
    if (chance(0.6)) {
      const double far = size(1e-2, 1e4);
      const auto along = [&] { return chance(0.3) ? 0.0 : far * (2 * uniform() - 1); };
      step.translation = {along(), along(), along()};
    }
    steps_.push_back(step);
    std::string numbers;
    for (const auto& [v, w] : {std::pair{step.x, 0}, {step.y, 0}, {step.z, 0}, {step.translation, 1}})
      numbers += fmt::format("{} {} {} {} ", v.x, v.y, v.z, w);
    return "ConcatTransform [" + numbers + "]\n";
  }

  std::mt19937_64 random_;
  Vec3d half_;
  double height_;
  std::vector<Step> steps_;
};

/// Number of rays that leave a hit, and of rays that hit the same surface again.
struct Tally {
  uint64_t rays = 0, again = 0;
};

/// Bounces inside random boxes, of which `again` leave through a wall.
Tally stay_in_random_boxes(unsigned first, unsigned count) {
  Tally tally;
  for (unsigned seed = first; seed < first + count; ++seed) {
    RandomMesh box(RandomMesh::Form::box, seed);
    const TextScene scene(box.text);
    const Vec3d middle = box.middle();
    for (int path = 0; path < 16; ++path) {
      Ray ray{scene.rendered(middle), to_float(box.direction(normalize(Vec3d{1, 2, 3})))};
      for (int bounce = 0; bounce < 64; ++bounce) {
        SurfacePoint point;
        ++tally.rays;
        if (!scene.world().intersect(ray, 1, point)) {
          ++tally.again;
          break;
        }
        const Vec3d n = to_double(dot(point.hit.ng, ray.d) < 0 ? point.hit.ng : -point.hit.ng);
        ray.d = to_float(box.direction(n));
        ray.o = offset_origin(point.hit, ray.d);
      }
    }
  }
  return tally;
}

/// Rays of all angles that leave both sides of random planes.
Tally leave_random_planes(unsigned first, unsigned count) {
  Tally tally;
  for (unsigned seed = first; seed < first + count; ++seed) {
    RandomMesh plane(RandomMesh::Form::plane, seed);
    const TextScene scene(plane.text);
    for (int i = 0; i < 64; ++i) {
      const auto [p, n] = plane.point();
      const Vec3d d = plane.direction(n);
      const double away = plane.distance();
      SurfacePoint point;
      if (!scene.world().intersect({scene.rendered(p + d * away), to_float(-d)}, 1, point)) continue;
      for (int k = 0; k < 16; ++k) {
        const Vec3 out = to_float(plane.direction(k % 2 ? n : -n));
        SurfacePoint other;
        ++tally.rays;
        tally.again += scene.world().intersect({offset_origin(point.hit, out), out}, 1, other);
      }
    }
  }
  return tally;
}

TEST(SelfIntersection, RaysLeaveRandomPlanes) {
  const Tally tally = leave_random_planes(1, slow_tests() ? 20000 : 200);
  EXPECT_GT(tally.rays, 100000u);
  EXPECT_EQ(tally.again, 0u) << "of " << tally.rays;
}

/// Points of thin boxes far from the origin round to the other side of a wall beside an edge: 0.2 % of the rays are
/// lost, whatever their offset. A wall that rays left by their own error would lose half of them.
TEST(SelfIntersection, RaysStayInRandomBoxes) {
  const Tally tally = stay_in_random_boxes(1, slow_tests() ? 20000 : 200);
  EXPECT_GT(tally.rays, 100000u);
  EXPECT_LT(double(tally.again), 0.004 * double(tally.rays));
}

/// Errors within a plane do not count: a large plane can be close to another one, also by rotations about its normal.
TEST(SelfIntersection, LargePlanesStayApart) {
  const auto plane = [](double z) {
    return fmt::format(
        "Shape \"trianglemesh\" \"point3 P\" [-200 -200 {0} 200 -200 {0} 200 200 {0} -200 200 {0}] "
        "\"integer indices\" [0 1 2 0 2 3]\n",
        z);
  };
  const std::string both = plane(0) + plane(0.001);
  const std::string object = "ObjectBegin \"o\"\n" + both + "ObjectEnd\n";
  for (const std::string& text :
       {both, "Rotate 33 0 0 1\n" + both, object + "Translate 1000 2000 0 Rotate 33 0 0 1 ObjectInstance \"o\"\n",
        object + "AttributeBegin ObjectBegin \"p\" Rotate 20 0 0 1 ObjectInstance \"o\" ObjectEnd AttributeEnd\n" +
            "Translate 1000 2000 0 Rotate 30 0 0 1 ObjectInstance \"p\"\n"}) {
    const TextScene scene(text);
    const Vec3 middle = scene.rendered(text.find("Translate") == std::string::npos ? Vec3d{} : Vec3d{1000, 2000, 0});
    for (const Vec3& d : {Vec3{0, 0, 1}, Vec3{0.1f, 0.2f, 1}}) {
      SurfacePoint lower, upper;
      ASSERT_TRUE(scene.world().intersect({middle + Vec3{20, 30, 0.0005f}, -d}, 1, lower)) << text;
      EXPECT_NEAR(lower.hit.p.z, 0, 1e-9);
      ASSERT_TRUE(scene.world().intersect({offset_origin(lower.hit, d), d}, 1, upper)) << text;
      EXPECT_NEAR(upper.hit.p.z, 0.001, 1e-9);
      EXPECT_FALSE(scene.world().occluded({offset_origin(upper.hit, d), d}, 1)) << text;
      EXPECT_TRUE(scene.world().occluded({offset_origin(upper.hit, -d), -d}, 1)) << text;
    }
  }
}

}  // namespace
}  // namespace frond
