#include "common.h"
#include "instruments/given_wavelengths.h"
#include "instruments/goniophotometer.h"
#include "instruments/material_conformance.h"
#include "instruments/spectrophotometer.h"
#include "render/material_words.h"
#include "render/measured_material.h"
#include "render/refusing_log.h"
#include "report/conform_report.h"
#include "scene/resolver.h"

namespace frond::python {
namespace {

using namespace nb::literals;

/// A material on an instrument's bench, prepared for wavelengths one by one.
struct Bench {
  std::shared_ptr<SessionHandle> owner;
  std::vector<double> wavelengths_nm;
  MeasuredMaterial material;
};

Exposure exposure_of(const Bench& bench, size_t wavelength, double theta_deg, uint64_t seed, bool as_rendered) {
  const Exposure exposure{bench.material.at(wavelength),
                          {theta_deg, bench.wavelengths_nm[wavelength]},
                          hash_key(seed, hash_bytes(bench.material.label())),
                          as_rendered};
  check_beam(exposure.beam);
  check_as_rendered(exposure);
  return exposure;
}

nb::dict shares(Bench& bench, size_t wavelength, double theta_deg, int64_t rays, double standard_error, uint64_t seed,
                bool as_rendered) {
  SpectrophotometerReading reading;
  {
    const nb::gil_scoped_release release;
    reading = measure_shares(exposure_of(bench, wavelength, theta_deg, seed, as_rendered), {rays, standard_error},
                             bench.owner->session.pool(), [](int64_t) { check_signals(); });
  }
  nb::dict d;
  d["theta_deg"] = theta_deg, d["wavelength_nm"] = bench.wavelengths_nm[wavelength];
  const auto add = [&d](const char* name, const Estimate& e) {
    d[name] = e.mean, d[(std::string(name) + "_se").c_str()] = e.standard_error();
  };
  if (reading.tells_surface) add("Rs", reading.surface), add("Rd", reading.subsurface);
  add("R", reading.reflectance), add("T", reading.transmittance), add("A", reading.absorptance);
  d["rays"] = reading.rays;
  return d;
}

nb::dict patches(Bench& bench, size_t wavelength, double theta_deg, int64_t rays, std::pair<int, int> patch_counts,
                 bool integrate, uint64_t seed, bool as_rendered) {
  std::vector<double> theta, phi, projected, f, error;
  {
    const nb::gil_scoped_release release;
    const DetectorSphere sphere(patch_counts.first, patch_counts.second);
    const Exposure exposure = exposure_of(bench, wavelength, theta_deg, seed, as_rendered);
    check_no_delta_lobe(exposure);
    const GoniophotometerReading reading =
        integrate && has_exact_f(exposure)
            ? integrate_f(exposure, sphere, bench.owner->session.pool())
            : measure_f(exposure, sphere, rays, bench.owner->session.pool(), [](int64_t) { check_signals(); });
    for (size_t i = 0; i < sphere.size(); ++i) {
      const Patch patch = sphere.patch(i);
      const Estimate e = reading.f(i);
      theta.push_back(patch.theta_deg()), phi.push_back(patch.phi_deg());
      projected.push_back(patch.projected_solid_angle);
      f.push_back(e.mean), error.push_back(e.standard_error());
    }
  }
  const std::vector<size_t> shape{size_t(patch_counts.first), size_t(patch_counts.second)};
  nb::dict d;
  d["theta_o_deg"] = to_array(std::move(theta), shape), d["phi_o_deg"] = to_array(std::move(phi), shape);
  d["projected_solid_angle_sr"] = to_array(std::move(projected), shape);
  d["f"] = to_array(std::move(f), shape), d["f_se"] = to_array(std::move(error), shape);
  return d;
}

/// A material's BSDF at up to four wavelengths, on a flat specimen.
class FlatBsdf {
 public:
  FlatBsdf(std::shared_ptr<SessionHandle> owner, const std::vector<std::string>& words, const std::vector<float>& nm)
      : owner_(std::move(owner)) {
    if (nm.empty() || nm.size() > kLanes) fail({}, "a BSDF has one to four wavelengths, {} were given", nm.size());
    const nb::gil_scoped_release release;
    const GivenWavelengths wavelengths(nm);
    lambda_ = wavelengths.sample(0);
    Session& session = owner_->session;
    material_ =
        ready_material(words, session.registry(), wavelengths, session.pool(), session.log(), owner_->options.cache);
    if (!material_->evaluate(flat_hit(), lambda_, arena_)) fail({}, "{}: there is no surface", words[0]);
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
    return wo.shape(0);
  }

  template <class Body>
  void for_blocks(size_t count, const Body& body) {
    constexpr size_t kBlock = 4096;
    const nb::gil_scoped_release release;
    owner_->session.pool().for_each(int64_t((count + kBlock - 1) / kBlock), [&](int64_t block, int) {
      Arena arena;
      const Bsdf& bsdf = *material_->evaluate(flat_hit(), lambda_, arena);
      for (size_t i = size_t(block) * kBlock; i < std::min(count, (size_t(block) + 1) * kBlock); ++i) body(bsdf, i);
    });
  }

  std::shared_ptr<SessionHandle> owner_;
  SampledWavelengths lambda_;
  std::shared_ptr<Material> material_;
  Arena arena_;
};

/// As frond conform does.
std::string conform(const std::shared_ptr<SessionHandle>& owner, const std::vector<std::string>& words,
                    const std::vector<double>& wavelengths_nm, const ExaminationEffort& effort, const Claims& claims,
                    double false_alarm_rate) {
  const nb::gil_scoped_release release;
  Session& session = owner->session;
  const MaterialWords material = parse_material(words, session.registry());
  const SceneDescription others = scene_of_materials(session.registry());
  const std::vector<ParameterSet> sets{{"as given", material.plugin}};
  std::string label = words[0];
  for (size_t i = 1; i < words.size(); ++i) label += " " + words[i];
  ConformReport report{label, wavelengths_nm, effort, false_alarm_rate, 0, {}};
  const RefusingLog refusing;
  for (size_t i = 0; i < wavelengths_nm.size(); i += kLanes) {
    const GivenWavelengths wavelengths(
        {wavelengths_nm.begin() + std::ptrdiff_t(i),
         wavelengths_nm.begin() + std::ptrdiff_t(std::min(wavelengths_nm.size(), i + kLanes))});
    SceneResolver resolver(others, session.registry(), wavelengths, refusing);
    const Preparation preparation{wavelengths, session.pool(), session.log(), owner->options.cache};
    const Findings findings = examine(material.info, sets, {preparation, resolver, claims, effort, true});
    report.findings.insert(report.findings.end(), findings.begin(), findings.end());
    check_signals();
  }
  report.level = judge(report.findings, false_alarm_rate);
  return conform_json(report);
}

}  // namespace

void bind_instruments(nb::module_& m) {
  nb::class_<Bench>(m, "Bench")
      .def(
          "__init__",
          [](Bench* self, const std::shared_ptr<SessionHandle>& owner, const std::vector<std::string>& words,
             const std::vector<double>& nm) {
            const nb::gil_scoped_release release;
            Session& s = owner->session;
            new (self) Bench{owner, nm, {words, s.registry(), nm, s.pool(), s.log(), owner->options.cache}};
          },
          "session"_a, "words"_a, "wavelengths"_a)
      .def("shares", &shares, "wavelength"_a, "theta_deg"_a, "rays"_a, "standard_error"_a, "seed"_a, "as_rendered"_a)
      .def("patches", &patches, "wavelength"_a, "theta_deg"_a, "rays"_a, "patches"_a, "integrate"_a, "seed"_a,
           "as_rendered"_a);

  nb::class_<FlatBsdf>(m, "FlatBsdf")
      .def(nb::init<std::shared_ptr<SessionHandle>, const std::vector<std::string>&, const std::vector<float>&>(),
           "session"_a, "words"_a, "wavelengths"_a)
      .def("f", &FlatBsdf::f, "wo"_a, "wi"_a, "seed"_a)
      .def("f_and_pdf", &FlatBsdf::f_and_pdf, "wo"_a, "wi"_a, "seed"_a)
      .def("sample_one", &FlatBsdf::sample_one, "wo"_a, "uc"_a, "u"_a, "seed"_a)
      .def("pdf", &FlatBsdf::pdf, "wo"_a, "wi"_a)
      .def("sample", &FlatBsdf::sample, "wo"_a, "seed"_a)
      .def_prop_ro("is_stochastic", &FlatBsdf::is_stochastic)
      .def_prop_ro("is_reciprocal", &FlatBsdf::is_reciprocal);

  m.def(
      "conform",
      [](const std::shared_ptr<SessionHandle>& owner, const std::vector<std::string>& words,
         const std::vector<double>& nm, const std::vector<double>& angles_deg, int samples, uint64_t seed,
         bool lossless, bool reciprocal, double false_alarm_rate) {
        return conform(owner, words, nm, {.samples = samples, .angles_deg = angles_deg, .seed = seed},
                       {lossless, reciprocal}, false_alarm_rate);
      },
      "session"_a, "words"_a, "wavelengths"_a, "angles_deg"_a, "samples"_a, "seed"_a, "lossless"_a, "reciprocal"_a,
      "false_alarm_rate"_a);
}

}  // namespace frond::python
