#include "common.h"
#include "instruments/beam.h"
#include "instruments/given_wavelengths.h"
#include "render/measured_material.h"

namespace frond::python {
namespace {

using namespace nb::literals;

/// A material's BSDF at up to four wavelengths, on a flat specimen.
class FlatBsdf {
 public:
  FlatBsdf(std::shared_ptr<SessionHandle> owner, const std::string& material, const std::vector<float>& nm)
      : owner_(std::move(owner)) {
    if (nm.empty() || nm.size() > kLanes) fail({}, "a BSDF has one to four wavelengths, {} were given", nm.size());
    const GivenWavelengths wavelengths(nm);
    lambda_ = wavelengths.sample(0);
    Session& session = owner_->session();
    run(
        [&](const RenderControl& control) {
          const StopScope stop(control.stop);
          material_ = prepared_material(material_text({material}), session.registry(), wavelengths, session.pool(),
                                        session.log(), owner_->context.options().cache);
        },
        nb::none());
    if (!material_->evaluate(flat_hit(), lambda_, arena_)) fail({}, "{}: there is no surface", material);
  }

  FlatBsdf(const FlatBsdf&) = delete;
  FlatBsdf& operator=(const FlatBsdf&) = delete;

  nb::ndarray<nb::numpy, float> f(const Directions& wo, const Directions& wi, uint64_t seed) {
    const size_t count = check_pairs(wo, wi), lanes = size_t(lambda_.count);
    std::vector<float> values(count * lanes);
    for_blocks(count, [&](const Bsdf& bsdf, size_t i) {
      RandomStream rng(hash_key(seed, i));
      const SampledSpectrum s = bsdf.f(direction(wo, i), direction(wi, i), rng);
      for (size_t lane = 0; lane < lanes; ++lane) values[i * lanes + lane] = s[int(lane)];
    });
    return to_array(std::move(values), {count, lanes});
  }

  nb::ndarray<nb::numpy, float> pdf(const Directions& wo, const Directions& wi) {
    const size_t count = check_pairs(wo, wi);
    std::vector<float> values(count);
    for_blocks(count, [&](const Bsdf& bsdf, size_t i) { values[i] = bsdf.pdf(direction(wo, i), direction(wi, i)); });
    return to_array(std::move(values), {count});
  }

  /// One direction for each wo: wi, its weight f |cos| / pdf by wavelength, and pdf; 0 where there is none.
  nb::tuple sample(const Directions& wo, uint64_t seed) {
    const size_t count = wo.shape(0), lanes = size_t(lambda_.count);
    check_directions(wo, "wo");
    std::vector<float> wi(count * 3), weight(count * lanes), pdf(count);
    for_blocks(count, [&](const Bsdf& bsdf, size_t i) {
      RandomStream numbers(hash_key(seed, i, 0)), rng(hash_key(seed, i, 1));
      const float uc = numbers.uniform(), u = numbers.uniform(), v = numbers.uniform();
      const auto s = bsdf.sample(direction(wo, i), uc, {u, v}, rng);
      if (!s) return;
      wi[3 * i] = s->wi.x, wi[3 * i + 1] = s->wi.y, wi[3 * i + 2] = s->wi.z;
      pdf[i] = s->pdf;
      for (size_t lane = 0; lane < lanes; ++lane)
        weight[i * lanes + lane] = s->f[int(lane)] * std::abs(s->wi.z) / s->pdf;
    });
    return nb::make_tuple(to_array(std::move(wi), {count, 3}), to_array(std::move(weight), {count, lanes}),
                          to_array(std::move(pdf), {count}));
  }

  using Numbers = std::array<float, 3>;

  /// For callers that have one pair at a time: f by wavelength, and pdf.
  std::pair<std::vector<float>, float> f_and_pdf(const Numbers& wo, const Numbers& wi, uint64_t seed) {
    check_direction(direction(wo), "wo");
    check_direction(direction(wi), "wi");
    arena_.reset();
    const Bsdf& bsdf = *material_->evaluate(flat_hit(), lambda_, arena_);
    RandomStream rng(seed);
    const SampledSpectrum s = bsdf.f(direction(wo), direction(wi), rng);
    return {values(s), bsdf.pdf(direction(wo), direction(wi))};
  }
  /// wi, f |cos| / pdf by wavelength, pdf, and whether it is of the surface's lobe; None where there is none.
  std::optional<std::tuple<Numbers, std::vector<float>, float, bool>> sample_one(const Numbers& wo, float uc,
                                                                                 std::pair<float, float> u,
                                                                                 uint64_t seed) {
    check_direction(direction(wo), "wo");
    if (!is_uniform(uc) || !is_uniform(u.first) || !is_uniform(u.second))
      fail({}, "uc and u are random numbers from 0 to below 1, {} and ({}, {}) were given", uc, u.first, u.second);
    arena_.reset();
    RandomStream rng(seed);
    const auto s =
        material_->evaluate(flat_hit(), lambda_, arena_)->sample(direction(wo), uc, {u.first, u.second}, rng);
    if (!s) return {};
    return std::tuple{Numbers{s->wi.x, s->wi.y, s->wi.z}, values(s->f * (std::abs(s->wi.z) / s->pdf)), s->pdf,
                      any(s->flags & Lobes::glossy)};
  }

  bool is_stochastic() {
    arena_.reset();
    return any(material_->evaluate(flat_hit(), lambda_, arena_)->flags() & Lobes::stochastic);
  }
  bool is_reciprocal() const { return material_->is_reciprocal(); }

 private:
  static bool is_uniform(float x) { return x >= 0 && x < 1; }
  static Vec3 direction(const Numbers& v) { return {v[0], v[1], v[2]}; }
  std::vector<float> values(const SampledSpectrum& s) const {
    std::vector<float> result;
    for (int lane = 0; lane < lambda_.count; ++lane) result.push_back(s[lane]);
    return result;
  }
  static Vec3 direction(const Directions& d, size_t i) {
    const float* v = d.data() + 3 * i;
    return {v[0], v[1], v[2]};
  }
  static size_t check_pairs(const Directions& wo, const Directions& wi) {
    if (wo.shape(0) != wi.shape(0)) fail({}, "{} wo and {} wi are no pairs", wo.shape(0), wi.shape(0));
    check_directions(wo, "wo");
    check_directions(wi, "wi");
    return wo.shape(0);
  }
  /// Throws InputError unless the vector has length 1 within the rounding of a caller's floats. A model may not
  /// terminate for other vectors.
  static void check_direction(const Vec3& v, std::string_view name) {
    constexpr float kRounding = 1e-3f;
    if (!(std::abs(dot(v, v) - 1) < kRounding))
      fail({}, "{}: directions are vectors of length 1, ({}, {}, {}) was given", name, v.x, v.y, v.z);
  }
  static void check_directions(const Directions& d, std::string_view name) {
    for (size_t i = 0; i < d.shape(0); ++i) check_direction(direction(d, i), name);
  }

  template <class Body>
  void for_blocks(size_t count, const Body& body) {
    constexpr size_t kBlock = 4096;
    const auto work = [&](int64_t block, int) {
      Arena arena;
      const Bsdf& bsdf = *material_->evaluate(flat_hit(), lambda_, arena);
      for (size_t i = size_t(block) * kBlock; i < std::min(count, (size_t(block) + 1) * kBlock); ++i) body(bsdf, i);
    };
    if (count <= kBlock) return work(0, 0);  // too short for a thread of its own
    run(
        [&](const RenderControl& control) {
          const StopScope stop(control.stop);
          owner_->session().pool().for_each(int64_t((count + kBlock - 1) / kBlock), work);
        },
        nb::none());
  }

  std::shared_ptr<SessionHandle> owner_;
  SampledWavelengths lambda_;
  std::shared_ptr<Material> material_;
  Arena arena_;
};

}  // namespace

void bind_bsdf(nb::module_& m) {
  nb::class_<FlatBsdf>(m, "FlatBsdf")
      .def(nb::init<std::shared_ptr<SessionHandle>, const std::string&, const std::vector<float>&>(), "session"_a,
           "material"_a, "wavelengths"_a)
      .def("f", &FlatBsdf::f, "wo"_a, "wi"_a, "seed"_a)
      .def("f_and_pdf", &FlatBsdf::f_and_pdf, "wo"_a, "wi"_a, "seed"_a)
      .def("sample_one", &FlatBsdf::sample_one, "wo"_a, "uc"_a, "u"_a, "seed"_a)
      .def("pdf", &FlatBsdf::pdf, "wo"_a, "wi"_a)
      .def("sample", &FlatBsdf::sample, "wo"_a, "seed"_a)
      .def_prop_ro("is_stochastic", &FlatBsdf::is_stochastic)
      .def_prop_ro("is_reciprocal", &FlatBsdf::is_reciprocal);
}

}  // namespace frond::python
