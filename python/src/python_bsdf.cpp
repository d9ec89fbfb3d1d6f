#include <deque>
#include <map>

#include "common.h"

namespace frond::python {
namespace {

using namespace nb::literals;

/// Raises an exception of Python, as if the methods of the object had.
[[noreturn]] void raise(PyObject* type, const std::string& message) {
  PyErr_SetString(type, message.c_str());
  throw nb::python_error();
}

/// A BSDF that is written in Python: an object of frond.Bsdf. Each call takes the GIL, so that renders of it use one
/// core. It lives in an arena; its creator keeps the Python object alive.
class PythonBsdf final : public Bsdf {
  // Before the functions that call it, because its type is deduced.
  /// Returns the value of `call`. A value of another type than `needed` becomes a TypeError that names the method.
  template <class Call>
  auto returned(const char* method, const char* needed, const Call& call) const {
    try {
      return call();
    } catch (const nb::cast_error&) {
      const std::string name = nb::cast<std::string>(self().type().attr("__name__"));
      raise(PyExc_TypeError, fmt::format("{}.{} returns {}", name, method, needed));
    }
  }

 public:
  PythonBsdf(PyObject* object, Lobes flags, const SampledWavelengths& lambda)
      : object_(object), flags_(flags), lambda_(lambda) {}

  Lobes flags() const override { return flags_; }

  SampledSpectrum f(const Vec3& wo, const Vec3& wi, RandomStream&) const override {
    if (wo.z == 0 || wi.z == 0) return {};  // along the surface nothing is scattered
    const nb::gil_scoped_acquire hold;
    return returned("f", "a number, or one for each wavelength",
                    [&] { return spectrum(self().attr("f")(tuple(wo), tuple(wi), nm())); });
  }

  std::optional<BsdfSample> sample(const Vec3& wo, float uc, Vec2 u, RandomStream&) const override {
    if (wo.z == 0) return {};
    const nb::gil_scoped_acquire hold;
    const nb::object found = self().attr("sample")(tuple(wo), uc, nb::make_tuple(u.x, u.y), nm());
    if (found.is_none()) return {};
    BsdfSample s = returned("sample", "None or (wi, f, pdf)", [&] {
      const auto [wi, f, pdf] = nb::cast<std::tuple<std::array<float, 3>, nb::object, float>>(found);
      return BsdfSample{.f = spectrum(f), .wi = {wi[0], wi[1], wi[2]}, .pdf = pdf};
    });
    const Lobes side = s.wi.z * wo.z > 0 ? Lobes::reflection : Lobes::transmission;
    s.flags = side | (flags_ & (Lobes::diffuse | Lobes::glossy));
    return s;
  }

  float pdf(const Vec3& wo, const Vec3& wi) const override {
    if (wo.z == 0 || wi.z == 0) return 0;
    const nb::gil_scoped_acquire hold;
    return returned("pdf", "a number", [&] { return nb::cast<float>(self().attr("pdf")(tuple(wo), tuple(wi), nm())); });
  }

 private:
  nb::handle self() const { return object_; }
  static nb::tuple tuple(const Vec3& v) { return nb::make_tuple(v.x, v.y, v.z); }

  nb::tuple nm() const {
    nb::list all;
    for (int i = 0; i < lambda_.count; ++i) all.append(lambda_.nm[size_t(i)]);
    return nb::tuple(all);
  }

  /// One number for all wavelengths, or one for each.
  SampledSpectrum spectrum(const nb::object& value) const {
    SampledSpectrum s;
    const bool is_number = PyNumber_Check(value.ptr()) && !PySequence_Check(value.ptr());
    const auto values = is_number ? std::vector<float>(size_t(lambda_.count), nb::cast<float>(value))
                                  : nb::cast<std::vector<float>>(value);
    if (values.size() != size_t(lambda_.count))
      raise(PyExc_ValueError,
            fmt::format("a BSDF is asked at {} wavelengths, and gave {} values", lambda_.count, values.size()));
    for (int i = 0; i < lambda_.count; ++i)
      if (lambda_.is_active(i)) s[i] = values[size_t(i)];
    return s;
  }

  PyObject* object_;
  Lobes flags_;
  SampledWavelengths lambda_;
};

std::vector<std::string> flag_words(const nb::handle& object) {
  if (!nb::hasattr(object, "flags")) throw nb::type_error("a BSDF is needed: an object of frond.Bsdf");
  try {
    return nb::cast<std::vector<std::string>>(object.attr("flags"));
  } catch (const nb::cast_error&) {
    throw nb::type_error("flags: a tuple of texts is needed");
  }
}

Lobes flags_of(const nb::handle& object) {
  Lobes flags = Lobes::none;
  for (const auto& word : flag_words(object)) {
    if (word == "reflection")
      flags = flags | Lobes::reflection;
    else if (word == "transmission")
      flags = flags | Lobes::transmission;
    else if (word == "diffuse")
      flags = flags | Lobes::diffuse;
    else if (word == "glossy")
      flags = flags | Lobes::glossy;
    else
      throw nb::value_error(
          fmt::format("flags: \"{}\" is none of reflection, transmission, diffuse, glossy", word).c_str());
  }
  if (!any(flags & (Lobes::reflection | Lobes::transmission)))
    throw nb::value_error("flags: reflection, transmission or both are needed");
  return flags;
}

/// A material of which every hit has the same BSDF of Python's.
class PythonMaterial final : public Material {
 public:
  explicit PythonMaterial(const nb::object& object)
      : object_(object), flags_(flags_of(object)), is_reciprocal_(nb::cast<bool>(object.attr("reciprocal"))) {}
  ~PythonMaterial() override {
    const nb::gil_scoped_acquire hold;
    object_.reset();
  }
  PythonMaterial(const PythonMaterial&) = delete;
  PythonMaterial& operator=(const PythonMaterial&) = delete;

  const Bsdf* evaluate(const Hit&, const SampledWavelengths& lambda, Arena& arena) const override {
    return arena.make<PythonBsdf>(object_.ptr(), flags_, lambda);
  }
  bool is_reciprocal() const override { return is_reciprocal_; }

 private:
  nb::object object_;
  Lobes flags_;
  bool is_reciprocal_;
};

/// Materials that Python has registered, by name. They stay as long as the process: scenes may refer to them.
struct Registered {
  std::string name, doc;
  PyObject* object;
  MaterialInfo info;
};
std::deque<Registered>& registered() {
  static auto* all = new std::deque<Registered>;
  return *all;
}

std::unique_ptr<Material> make_python_material(const Params& p) {
  const nb::gil_scoped_acquire hold;
  // By the record and not by its name, for each session has its own names.
  const auto& all = registered();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Registered& r) { return &r.info == &p.info(); });
  return std::make_unique<PythonMaterial>(nb::borrow(found->object));
}

}  // namespace

void bind_python_bsdf(nb::module_& m) {
  m.def(
      "register_material",
      [](const std::shared_ptr<SessionHandle>& owner, const std::string& name, const std::string& doc,
         const nb::object& object) {
        (void)flags_of(object);
        Registered& r = registered().emplace_back(name, doc, object.ptr(), MaterialInfo{});
        r.info.kind = "material", r.info.name = r.name, r.info.doc = r.doc, r.info.source = "Python";
        r.info.make = make_python_material;
        try {
          owner->session().add_material(r.info);
        } catch (...) {
          registered().pop_back();
          throw;
        }
        object.inc_ref();
      },
      "session"_a, "name"_a, "doc"_a, "bsdf"_a);
}

}  // namespace frond::python
