#include "tests/stability/cases.h"
#include "tests/stability/specimen.h"
#include "tests/support/goniometer_text.h"
#include "tests/support/input_error.h"

namespace frond::stability {
namespace {

using test::goniometer_text;
using test::GoniometerAngles;
using test::words;

constexpr std::string_view kGoniometerHead = "incidence_deg,wavelength_nm,theta_deg,phi_deg,f_per_sr\n";
constexpr double kMeasuredNm = 551;

/// R and T of a table whose f is constant on each side.
struct Constant {
  double reflected, transmitted;
  double f(double incidence, double theta) const {
    return ((incidence <= 90) == (theta < 90) ? reflected : transmitted) / std::numbers::pi;
  }
};

class Files {
 public:
  explicit Files(Theme& theme) : theme_(theme) {}

  /// Adds a case of a table of a constant f. R and T by integration and by samples must equal `expected` at all angles,
  /// to the horizon on both sides.
  void holds(std::string name, const GoniometerAngles& angles, Constant given, Constant expected) {
    const auto f = [given](double incidence, double theta, double, double) { return given.f(incidence, theta); };
    Comparison comparison(2e-5);
    const std::string file = folder_.write("t.csv", goniometer_text(angles, f)).string();
    for (const double theta : {0.0, 8.0, 60.0, 89.0, 89.999, 91.0, 180.0}) add(comparison, file, theta, expected);
    theme_.add(std::move(name), fmt::format("R {:g}, T {:g} at all angles", expected.reflected, expected.transmitted))
        .add(Method::measured, comparison.cell());
  }

  void refuses(std::string name, std::string_view text, const std::string& part) {
    const std::string file = folder_.write("t.csv", text).string();
    theme_.add(std::move(name), expect_refusal(part))
        .add(Method::measured,
             refusal(
                 part, [&] { Specimen("measured", {words("filename", {file})}, kMeasuredNm); }, folder_.name_of("")));
  }

 private:
  static void add(Comparison& comparison, const std::string& file, double theta, Constant expected) {
    try {
      Specimen specimen("measured", {words("filename", {file})}, kMeasuredNm);
      const leaf::Shares shares = integrate_shares(specimen, theta);
      comparison.add("R", shares.subsurface, expected.reflected);
      comparison.add("T", shares.transmitted, expected.transmitted);
      const Vec3 wo = toward_in_float(theta);
      RandomStream rng(1);
      for (int i = 0; i < 2000; ++i) {
        const auto s = specimen.bsdf().sample(wo, rng.uniform(), {rng.uniform(), rng.uniform()}, rng);
        comparison.require(!s || (s->f.is_physical() && s->pdf > 0), "a sample is no number");
        if (s) comparison.add("weight of a sample", double(s->f[0] * std::abs(s->wi.z) / s->pdf), sum(expected));
      }
    } catch (const InputError& error) {
      comparison.require(false, error.what());
    }
  }
  static double sum(Constant c) { return c.reflected + c.transmitted; }

  Theme& theme_;
  TestFolder folder_{"stability"};
};

void add_accepted(Files& files) {
  const std::vector<double> all{0, 30, 60, 89.9, 90.1, 120, 180}, thetas{0, 30, 60, 89.9, 90.1, 120, 180};
  const Constant c{0.3, 0.2};
  files.holds("both sides, directions to the horizon", {all, {kMeasuredNm}, thetas, {0, 90, 180, 270}}, c, c);
  files.holds("one incidence, one direction on each side", {{8}, {kMeasuredNm}, {45, 135}, {0}}, c, c);
  files.holds("light at 90 degrees", {{90}, {kMeasuredNm}, {45, 135}, {0, 180}}, c, c);
  files.holds("azimuths from -1e9 to 1e9 degrees", {{8}, {kMeasuredNm}, {45, 135}, {-1e9, 0, 1e9 + 100}}, c, c);
  files.holds("R + T = 1", {all, {kMeasuredNm}, thetas, {0, 120, 240}}, {0.4, 0.6}, {0.4, 0.6});
  files.holds("R + T = 2: scaled, with a warning", {all, {kMeasuredNm}, thetas, {0}}, {1.5, 0.5}, {0.75, 0.25});
  files.holds("f of 1e6: scaled, with a warning", {all, {kMeasuredNm}, thetas, {0}}, {3e6, 1e6}, {0.75, 0.25});
  files.holds("f of 1e-30", {all, {kMeasuredNm}, thetas, {0}}, {1e-30, 1e-30}, {0, 0});
  files.holds("f below 0: counts as 0, with a warning", {all, {kMeasuredNm}, thetas, {0}}, {-0.1, 0.3}, {0, 0.3});
  files.holds("f = 0", {all, {kMeasuredNm}, thetas, {0}}, {0, 0}, {0, 0});
}

void add_refused(Files& files) {
  const auto row = [](std::string_view rows) { return std::string(kGoniometerHead) + std::string(rows); };
  files.refuses("an empty file", "", "neither a tensor file nor a goniometer table");
  files.refuses("only the header", kGoniometerHead, "there are no rows of numbers");
  files.refuses("a missing column", "incidence_deg,wavelength_nm,theta_deg,f_per_sr\n",
                "there is no column \"phi_deg\"");
  files.refuses("a row too short", row("8,551,10,0\n"), "4 fields, but the file has 5 columns");
  files.refuses("NaN", row("8,551,10,0,nan\n"), "is no number");
  files.refuses("f of 1e7", row("8,551,10,0,1e7\n"), "outside its range -1000000 to 1000000");
  files.refuses("a detector at 90 degrees", row("8,551,90,0,0.1\n"), "on neither side");
  files.refuses("an incidence of 181", row("181,551,10,0,0.1\n"), "outside its range 0 to 180");
  files.refuses("one direction twice", row("8,551,10,0,0.1\n8,551,10,360,0.1\n"), "there are two values");
  files.refuses("a wavelength missing at one incidence", row("8,551,10,0,0.1\n8,608,10,0,0.1\n40,551,10,0,0.1\n"),
                "608 nm is missing at an incidence of 40");
  files.refuses("a wavelength outside the table", row("8,608,10,0,0.1\n8,800,10,0,0.1\n"), "from 608 to 800 nm");
  files.refuses("a tensor file of 12 bytes", std::string_view("tensor_file\0", 12), "it is truncated");
}

/// The metal of tests/pbrt_reference: R and sample weights to the horizon.
void add_tensor(Theme& theme) {
  for (const char* name : {"metal", "brushed"})
    for (const double theta : {0.0, 60.0, 88.0, 89.9, 89.9999}) {
      Comparison comparison;
      Specimen specimen("measured",
                        {words("filename", {fmt::format("{}/tests/pbrt_reference/{}.bsdf", FROND_SOURCE_DIR, name)})},
                        kMeasuredNm);
      const Vec3 wo = toward_in_float(theta);
      RandomStream rng(1);
      double sum = 0;
      constexpr int kSamples = 20000;
      for (int i = 0; i < kSamples; ++i) {
        const auto s = specimen.bsdf().sample(wo, rng.uniform(), {rng.uniform(), rng.uniform()}, rng);
        comparison.require(!s || (s->f.is_physical() && s->pdf > 0), "a sample is no number");
        if (s) sum += double(s->f[0] * s->wi.z / s->pdf) / kSamples;
      }
      comparison.require(sum > 0.1 && sum < 0.66, "R is not between 0.1 and the reflectance of a facet, 0.66");
      theme
          .add(fmt::format("tensor file {}.bsdf, {:g} degrees", name, theta),
               "samples are numbers, R below that of a facet")
          .add(Method::measured, comparison.cell());
    }
}

}  // namespace

Theme measured() {
  Theme theme{
      "Measured BSDFs",
      "Material `measured` at 551 nm. For accepted tables, R and T by integration of f, and the weights of 2000 "
      "samples at each angle, are compared with those of the table, whose f is constant on each side."};
  Files files(theme);
  add_accepted(files);
  add_refused(files);
  add_tensor(theme);
  return theme;
}

}  // namespace frond::stability
