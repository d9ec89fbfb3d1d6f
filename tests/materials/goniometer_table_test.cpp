#include <gmock/gmock.h>

#include <fstream>

#include "instruments/goniophotometer.h"
#include "instruments/spectrophotometer.h"
#include "materials/measured/goniometer_rows.h"
#include "tests/materials/support.h"
#include "tests/support/goniometer_text.h"
#include "tests/support/input_error.h"

/// Material "measured" with tables of a goniometer.
namespace frond::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::vector<double> kNm{360, 600, 830}, kThetas{10, 45, 80, 100, 135, 170}, kPhis{0, 90, 180, 270};

std::string written(const std::string& text) {
  std::string path = ::testing::TempDir() + "frond_goniometer.csv";
  std::ofstream(path) << text;
  return path;
}

Ready ready_of(const std::string& text) { return {"measured", {words("filename", {written(text)})}}; }

std::string error_of_text(const std::string& text) {
  return error_of([&] { ready_of(text); });
}

/// f at 608 nm; angles from the front's normal, degrees.
float f_of(Ready& ready, Vec2 wo, Vec2 wi) {
  const auto direction = [](Vec2 degrees) {
    const float theta = degrees.x * kPi / 180, phi = degrees.y * kPi / 180;
    return Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  RandomStream rng(1);
  return ready.bsdf().f(direction(wo), direction(wi), rng)[0];
}

TEST(GoniometerTable, IsLinearInAllAngles) {
  const auto f = [](double i, double theta, double phi, double) {
    return (0.1 + 0.001 * i) * (0.05 + 1e-4 * theta + 1e-4 * std::min(phi, 360 - phi));
  };
  Ready ready = ready_of(goniometer_text({{0, 40, 80}, kNm, kThetas, kPhis}, f));
  for (const Vec2 wi : {Vec2{20, 30}, Vec2{60, 170}, Vec2{110, 5}, Vec2{150, 120}})
    EXPECT_NEAR(f_of(ready, {30, 25}, {wi.x, wi.y + 25}), f(30, double(wi.x), double(wi.y), 0), 1e-6);
  EXPECT_NEAR(f_of(ready, {30, 0}, {60, -30}), f(30, 60, 30, 0), 1e-6) << "around the turn";
  EXPECT_NEAR(f_of(ready, {30, 0}, {87, 30}), f(30, 80, 30, 0), 1e-6) << "beyond the last ring";
  EXPECT_NEAR(f_of(ready, {88, 0}, {45, 30}), f(80, 45, 30, 0), 1e-6) << "beyond the last incidence";
  EXPECT_NEAR(f_of(ready, {30, 0}, {0, 0}), f(30, 10, 90, 0), 1e-6) << "the mean of the first ring";
  EXPECT_NEAR(f_of(ready, {150, 0}, {135, 90}), f(30, 45, 90, 0), 1e-6) << "the other side scatters alike";
}

TEST(GoniometerTable, IsLinearInTheWavelength) {
  Ready ready =
      ready_of(goniometer_text({{0}, kNm, kThetas, kPhis}, [](double, double, double, double nm) { return nm / 1e4; }));
  EXPECT_NEAR(f_of(ready, {0, 0}, {45, 0}), 0.0608, 1e-6);
}

TEST(GoniometerTable, HasTwoSides) {
  const auto f = [](double i, double theta, double, double) {
    const bool front = i < 90, above = theta < 90;
    return front ? (above ? 0.1 : 0.05) : (above ? 0.04 : 0.15);
  };
  Ready ready = ready_of(goniometer_text({{0, 180}, kNm, kThetas, kPhis}, f));
  for (const float o : {20.f, 160.f})
    for (const float i : {50.f, 130.f}) EXPECT_NEAR(f_of(ready, {o, 0}, {i, 77}), f(double(o), double(i), 0, 0), 1e-6);
}

TEST(GoniometerTable, MirrorsHalfAPlaneAndFillsGaps) {
  const auto f = [](double, double, double phi, double) { return phi / 1800; };
  Ready half = ready_of(goniometer_text({{30}, kNm, {20, 60}, {0, 45, 180}}, f));
  EXPECT_NEAR(f_of(half, {30, 0}, {60, 90}), 0.05, 1e-6);
  EXPECT_NEAR(f_of(half, {30, 0}, {60, 270}), 0.05, 1e-6);
  EXPECT_EQ(f_of(half, {30, 0}, {120, 0}), 0) << "no BTDF";
  EXPECT_FALSE(any(half.bsdf().flags() & Lobes::transmission));
  std::string with_gap;  // a detector that hides the light at one angle
  for (const double nm : kNm)
    with_gap += fmt::format(
        "30,{0},30,0,0.02\n30,{0},30,60,0.05\n30,{0},30,300,0.05\n30,{0},60,0,0.1\n30,{0},60,180,0.1\n", nm);
  Ready gap = ready_of("incidence_deg,wavelength_nm,theta_deg,phi_deg,f_per_sr\n" + with_gap);
  EXPECT_NEAR(f_of(gap, {30, 0}, {30, 150}), 0.05, 1e-6);
  EXPECT_NEAR(f_of(gap, {30, 0}, {45, 30}), (0.035 + 0.1) / 2, 1e-6);
}

TEST(GoniometerTable, ConservesEnergy) {
  const std::string text = goniometer_text({{0, 60}, kNm, kThetas, kPhis}, [](double i, double, double, double) {
    return i < 30 ? 0.1 : 0.2;  // R + T of 0.2 pi and 0.4 pi
  });
  Ready ready = ready_of(text);
  EXPECT_NEAR(f_of(ready, {0, 0}, {30, 0}), 0.1, 1e-6);
  EXPECT_NEAR(f_of(ready, {60, 0}, {30, 0}), double(kInvPi) / 2, 1e-6);
}

/// A table as `frond goniophotometer` makes it.
std::string measured_text(const Material& material, const std::vector<double>& incidences,
                          const DetectorSphere& sphere) {
  std::string text = "incidence_deg,wavelength_nm,theta_deg,phi_deg,projected_solid_angle_sr,f_per_sr,kind\n";
  for (const double incidence : incidences) {
    const auto m = integrate_f({material, {incidence, 550}}, sphere, ThreadPool(2));
    for (size_t i = 0; i < sphere.size(); ++i) {
      const Patch p = sphere.patch(i);
      text += fmt::format("{},550,{},{},{},{},{}\n", incidence, p.theta_deg(), p.phi_deg(), p.projected_solid_angle,
                          m.f(i).mean, m.is_reflected(p) ? "BRDF" : "BTDF");
    }
  }
  return text;
}

/// A material at 550 nm.
std::unique_ptr<Material> prepared(std::string_view name, std::vector<ParsedParam> params) {
  Resolver resolver;
  const MaterialInfo& info = material_info(name);
  auto material = info.make(Params(info, {std::string(name), {}, std::move(params)}, resolver));
  const OneWavelength one(550);
  ThreadPool pool(2);
  material->prepare({one, pool, silent_log(), {}});
  return material;
}

TEST(GoniometerTable, RepeatsALeafThatTheGoniophotometerMeasured) {
  const DetectorSphere sphere(20, 40);
  const auto leaf = prepared("leaf_solved", {});
  const auto table =
      prepared("measured", {words("filename", {written(measured_text(*leaf, {0, 30, 40, 150}, sphere))})});
  for (const auto& [incidence, tolerance] : {std::pair(30.0, 0.012), {150.0, 0.02}, {35.0, 0.03}}) {
    const auto expected = integrate_f({*leaf, {incidence, 550}}, sphere, ThreadPool(2));
    const auto found = integrate_f({*table, {incidence, 550}}, sphere, ThreadPool(2));
    double error = 0, square = 0;
    for (size_t i = 0; i < sphere.size(); ++i) {
      const double weight = sphere.patch(i).projected_solid_angle, e = expected.f(i).mean;
      error += weight * std::pow(found.f(i).mean - e, 2), square += weight * e * e;
    }
    EXPECT_LT(std::sqrt(error / square), tolerance) << incidence;
    for (const bool reflected : {true, false})
      EXPECT_NEAR(found.share(reflected).mean, expected.share(reflected).mean, incidence == 35 ? 2e-3 : 3e-5)
          << incidence;
  }
}

TEST(GoniometerTable, NamesWhatIsWrong) {
  const std::string head = "incidence_deg,wavelength_nm,theta_deg,phi_deg,f_per_sr,kind,material\n";
  const auto of_rows = [&head](const std::string& rows) { return error_of_text(head + rows); };
  EXPECT_THAT(error_of_text("nothing"), HasSubstr("there is no column \"incidence_deg\""));
  EXPECT_THAT(error_of_text(""), HasSubstr("neither a tensor file nor a goniometer table"));
  EXPECT_THAT(of_rows("0,550,10,0,zero,BRDF,a\n"),
              AllOf(HasSubstr("goniometer.csv:2:12"), HasSubstr("\"zero\" is no number")));
  EXPECT_THAT(of_rows("0,550,10,0,1\n"), HasSubstr("5 fields, but the file has 7 columns"));
  EXPECT_THAT(of_rows("0,550,190,0,1,BTDF,a\n"), HasSubstr("theta_deg is 190, outside its range 0 to 180"));
  EXPECT_THAT(of_rows("0,550,90,0,1,BTDF,a\n"), HasSubstr("on neither side"));
  EXPECT_THAT(of_rows("0,550,100,0,1,BRDF,a\n"), HasSubstr("measure the BTDF"));
  EXPECT_THAT(of_rows("0,550,10,0,1,BRDF,a\n0,550,10,360,1,BRDF,a\n"),
              AllOf(HasSubstr(":3:"), HasSubstr("two values")));
  EXPECT_THAT(of_rows("0,550,10,0,1,BRDF,a\n0,550,10,9,1,BRDF,\"b,c\"\n"), HasSubstr("measurements of a and b,c"));
  EXPECT_THAT(of_rows("0,550,10,0,1,BRDF,a\n0,650,10,0,1,BRDF,a\n5,550,10,0,1,BRDF,a\n"),
              HasSubstr("650 nm is missing"));
  EXPECT_THAT(of_rows("0,550,10,0,1,BRDF,a\n5,550,170,0,1,BTDF,a\n"), HasSubstr("same angles of incidence"));
  EXPECT_THAT(of_rows("0,550,10,0,0.1,BRDF,a\n"), HasSubstr("known from 550 to 550 nm"));
  std::string spiral;
  for (int i = 0; i < 5000; ++i) spiral += fmt::format("0,550,{},{},0.1,BRDF,a\n", 0.017 * i, 0.07 * i);
  EXPECT_THAT(of_rows(spiral), HasSubstr("rings of equal theta_deg are needed"));
}

}  // namespace
}  // namespace frond::test
