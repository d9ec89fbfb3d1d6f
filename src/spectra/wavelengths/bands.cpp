#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "core/fluorescence.h"
#include "core/wavelengths.h"
#include "spectra/response_file.h"
#include "spectra/wavelengths/registry.h"
#include "spectra/wavelengths/response_sampler.h"

namespace frond {
namespace {

constexpr size_t kMostBands = 10000;

constexpr Param kBandsParams[] = {
    {.name = "wavelengths",
     .kind = ParamKind::real,
     .unit = "nm",
     .range = kWavelengthRange_nm,
     .doc = "One band at each of these wavelengths.",
     .list = true},
    {.name = "responses",
     .kind = ParamKind::string,
     .doc =
         "Files of a sensor's responses: of all bands (s2a.csv), of one band, or one column of a table (s2a.csv:B4). "
         "A channel is the mean radiance under its response.",
     .list = true},
    {.name = "ranges",
     .kind = ParamKind::real,
     .unit = "nm",
     .range = kWavelengthRange_nm,
     .doc = "Pairs of first and last wavelengths, one for each band: its response is 1 between them.",
     .list = true},
    {.name = "names",
     .kind = ParamKind::string,
     .doc =
         "Names of the bands of \"responses\" or \"ranges\", for channels, columns and rows; by default those of the "
         "files, or 400-700.",
     .list = true},
    {.name = "lambdamin",
     .kind = ParamKind::real,
     .default_value = 400.0,
     .unit = "nm",
     .range = kWavelengthRange_nm,
     .doc = "First of evenly spaced wavelengths, if no list is given."},
    {.name = "lambdamax",
     .kind = ParamKind::real,
     .default_value = 700.0,
     .unit = "nm",
     .range = kWavelengthRange_nm,
     .doc = "Last of the evenly spaced wavelengths; included if a step ends there."},
    {.name = "step",
     .kind = ParamKind::real,
     .default_value = 10.0,
     .unit = "nm",
     .range = {0.1, 2200},
     .doc = "Step of the evenly spaced wavelengths."},
    {.name = "fluorescence",
     .kind = ParamKind::real,
     .unit = "nm",
     .range = kEmission_nm,
     .doc =
         "One band of fluorescence at each of these wavelengths: the light that leaves emit there, without what they "
         "reflect (docs/fluorescence.md). Reflected light has bands beside these only where one of the other "
         "parameters is given.",
     .list = true},
};

std::vector<double> even_wavelengths(const Params& p) {
  const double min = p.real("lambdamin"), max = p.real("lambdamax"), step = p.real("step");
  if (min > max) fail(p.where("lambdamax"), "\"lambdamax\" is {} nm, below \"lambdamin\", {} nm", max, min);
  std::vector<double> nm;
  const auto last = static_cast<int>(std::floor((max - min) / step + 1e-6));
  for (int i = 0; i <= last; ++i) nm.push_back(min + i * step);
  return nm;
}

void check_choice(const Params& p) {
  const bool listed = p.given("wavelengths"), sensor = p.given("responses"), ranges = p.given("ranges");
  if (listed && sensor) fail(p.where("responses"), "\"wavelengths\" and \"responses\" exclude each other");
  if (ranges && (listed || sensor))
    fail(p.where("ranges"), "\"ranges\" and \"{}\" exclude each other", listed ? "wavelengths" : "responses");
  if (p.given("names") && !sensor && !ranges)
    fail(p.where("names"), "\"names\" are those of \"responses\": a single wavelength is its own name");
  for (const std::string_view name : {"lambdamin", "lambdamax", "step"})
    if ((listed || sensor || ranges) && p.given(name))
      fail(p.where(name), "\"{}\" is for evenly spaced wavelengths: others are given", name);
}

/// Whether the reflected light has bands: there are no others, or parameters of theirs are given.
bool has_reflected(const Params& p) {
  constexpr std::string_view kOfReflected[] = {"wavelengths", "responses", "lambdamin", "lambdamax", "step"};
  return !p.given("fluorescence") ||
         std::ranges::any_of(kOfReflected, [&p](std::string_view name) { return p.given(name); });
}

/// Throws InputError for a name that cannot stand in a column of CSV or in a channel of an EXR file.
void check_name(const std::string& name, const Location& where) {
  const auto is_bad = [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0 || c == ',' || c == '"'; };
  if (name.empty()) fail(where, "a band's name is empty");
  if (std::ranges::any_of(name, is_bad))
    fail(where, "\"{}\" is no name for a band: commas, quotes and control characters are not allowed", name);
  if (name.ends_with("_se"))
    fail(where, "\"{}\" is no name for a band: columns that end in _se are standard errors", name);
}

/// Any number of spectral bands, in the order in which they are given. A path carries at most four of them; consecutive
/// samples carry different bands in turn. Each channel is the mean over the samples that carried its band.
class Bands final : public WavelengthStrategy {
 public:
  explicit Bands(const Params& p) {
    check_choice(p);
    const std::vector<double> even = even_wavelengths(p), listed = p.reals("wavelengths");
    const auto files = p.files("responses");
    if (!files.empty())
      read_responses(files, p);
    else if (p.given("ranges"))
      add_ranges(p);
    else if (has_reflected(p))
      for (const double nm : listed.empty() ? even : listed) bands_.push_back({nm});
    const Location where = p.where(!files.empty() ? "responses" : p.given("ranges") ? "ranges" : "wavelengths");
    check_single_wavelengths(bands_, where);
    reflected_ = bands_.size();
    add_fluorescence(p);
    if (bands_.size() > kMostBands) fail(where, "these are {} bands, {} is the limit", bands_.size(), kMostBands);
    for (const Band& band : bands_)
      if (band.response.empty())
        nm_.push_back(static_cast<float>(band.nm));
      else
        samplers_.emplace_back(band.response, where);
    if (has_fluorescence()) nm_.clear();  // paths carry wavelengths of excitation, too, which are continuous
    listed_nm_ = nm_;
    std::ranges::sort(listed_nm_);
    find_range();
  }

  /// Chooses the bands at random: a few samples may miss a band, unlike samples by sample_for_index.
  SampledWavelengths sample(float u) const override {
    // Twice as many turns where the two kinds of bands alternate.
    const double turn = double(u) * double(bands_.size()) * (has_fluorescence() && reflected_ > 0 ? 2 : 1);
    return sample_for_index(static_cast<uint64_t>(turn), static_cast<float>(turn - std::floor(turn)));
  }

  /// A path carries reflected light or fluorescence, in turn.
  SampledWavelengths sample_for_index(uint64_t index, float u) const override {
    const size_t emitted = bands_.size() - reflected_;
    if (emitted == 0) return some_of(0, reflected_, index, u);
    if (reflected_ == 0) return some_of(0, emitted, index, u);
    return index % 2 == 0 ? some_of(0, reflected_, index / 2, u) : some_of(reflected_, emitted, index / 2, u);
  }

  Interval range_nm() const override { return range_nm_; }
  std::span<const float> fixed_nm() const override {
    return nm_.size() <= kLanes ? std::span<const float>(nm_) : std::span<const float>();
  }
  std::span<const float> listed_nm() const override { return listed_nm_; }
  std::span<const Band> bands() const override { return bands_; }
  std::string_view film_space() const override { return {}; }

  SensorResponse sensor(const SampledSpectrum& radiance, const SampledWavelengths& lambda) const override {
    SensorResponse response;
    response.count = lambda.count;
    for (size_t i = 0; i < size_t(lambda.count); ++i) {
      response.channel[i] = lambda.band[i];
      response.value[i] = double(radiance.v[i]);
    }
    return response;
  }

 private:
  bool has_fluorescence() const { return reflected_ < bands_.size(); }

  /// Returns up to four of `count` bands. The lanes are a quarter of the bands apart, so that noise common to the lanes
  /// of a path changes the brightness of a pixel and not its colour.
  SampledWavelengths some_of(size_t first, size_t count, uint64_t index, float u) const {
    const size_t lanes = std::min<size_t>(count, kLanes);
    SampledWavelengths lambda;
    lambda.count = static_cast<int>(lanes);
    for (size_t i = 0; i < lanes; ++i) {
      const size_t band = first + (count <= kLanes ? i : (index + i * count / kLanes) % count);
      lambda.band[i] = static_cast<uint16_t>(band);
      lambda.active[i] = true;
      lambda.nm[i] = band < samplers_.size() ? samplers_[band].sample(u) : static_cast<float>(bands_[band].nm);
      lambda.pdf[i] = 1;
    }
    return lambda;
  }

  /// Appends the bands of fluorescence, named F740.
  void add_fluorescence(const Params& p) {
    for (const double nm : p.reals("fluorescence")) bands_.push_back({nm, {}, fmt::format("F{:.8g}", nm)});
    check_single_wavelengths(std::span(bands_).subspan(reflected_), p.where("fluorescence"));
    for (size_t i = reflected_; i < bands_.size(); ++i)
      if (std::ranges::count(bands_, bands_[i].name, &Band::name) > 1)
        fail(p.where("names"), "\"{}\" is the name of a band of fluorescence", bands_[i].name);
  }

  /// Bands without a response are named after their wavelength, which must therefore be unique.
  static void check_single_wavelengths(std::span<const Band> bands, const Location& where) {
    constexpr double kLeast_nm = 1e-6;
    std::vector<double> nm;
    for (const Band& band : bands)
      if (band.response.empty()) nm.push_back(band.nm);
    std::ranges::sort(nm);
    for (size_t i = 1; i < nm.size(); ++i)
      if (nm[i] - nm[i - 1] < kLeast_nm) fail(where, "there are two bands at {:.8g} nm", nm[i]);
  }

  void read_responses(const std::vector<std::filesystem::path>& files, const Params& p) {
    const Location where = p.where("responses");
    for (const auto& file : files) {
      const std::vector<BandResponse> of_file = frond::read_responses(file, where);
      std::string left_out;
      for (const BandResponse& band : of_file) {
        std::vector<ResponsePoint> response;
        for (const SpectrumPoint& point : band.points) response.push_back({point.lambda_nm, point.value});
        // Tables of whole sensors have thermal bands, and bands that the sensor of this name lacks.
        if (of_file.size() > 1 && (response.empty() || !kWavelengthRange_nm.contains(centroid_nm(response, where)))) {
          left_out += fmt::format("{}{}", left_out.empty() ? "" : ", ", band.name);
          continue;
        }
        bands_.push_back({centroid_nm(response, where), response, band.name});
      }
      if (!left_out.empty())
        p.warn("responses",
               fmt::format("{}: bands without a response from {:g} to {:g} nm are left out: {}",
                           file.filename().string(), kWavelengthRange_nm.min, kWavelengthRange_nm.max, left_out));
    }
    set_names(p, "responses");
  }

  static double centroid_nm(const std::vector<ResponsePoint>& response, const Location& where) {
    return ResponseSampler(response, where).centroid_nm();
  }

  void add_ranges(const Params& p) {
    const std::vector<double> ends = p.reals("ranges");
    if (ends.size() % 2 != 0)
      fail(p.where("ranges"), "\"ranges\" takes pairs of wavelengths, as in 400,700,700,1100: {} were given",
           ends.size());
    for (size_t i = 0; i < ends.size(); i += 2) {
      const double first = ends[i], last = ends[i + 1];
      if (!(first < last)) fail(p.where("ranges"), "\"ranges\": {} to {} nm is empty", first, last);
      bands_.push_back({(first + last) / 2, {{first, 1}, {last, 1}}, fmt::format("{}-{}", first, last)});
    }
    set_names(p, "ranges");
  }

  /// Replaces the names by "names", and checks them. `source`: the parameter that gives the bands.
  void set_names(const Params& p, std::string_view source) {
    const Location where = p.where(p.given("names") ? "names" : source);
    if (p.given("names")) rename(p.strings("names"), where);
    for (const Band& band : bands_) check_name(band.name, where);
    std::set<std::string_view> names;
    for (const Band& band : bands_)
      if (!names.insert(band.name).second)
        fail(where, "two bands are named \"{}\": \"names\" gives each band a name of its own, as in names=red,nir",
             band.name);
  }

  void rename(const std::vector<std::string>& names, const Location& where) {
    if (names.size() != bands_.size()) fail(where, "\"names\" has {} names for {} bands", names.size(), bands_.size());
    for (size_t i = 0; i < names.size(); ++i) bands_[i].name = names[i];
  }

  void find_range() {
    const auto [least, most] = std::ranges::minmax(bands_, {}, &Band::nm);
    range_nm_ = {least.nm, most.nm};
    for (const ResponseSampler& sampler : samplers_) {
      range_nm_.min = std::min(range_nm_.min, sampler.support_nm().min);
      range_nm_.max = std::max(range_nm_.max, sampler.support_nm().max);
    }
    if (!has_fluorescence()) return;
    range_nm_.min = std::min(range_nm_.min, kExcitation_nm.min);
    range_nm_.max = std::max(range_nm_.max, kExcitation_nm.max);
  }

  std::vector<Band> bands_;
  size_t reflected_ = 0;                   ///< number of bands of reflected light, which are the first
  std::vector<float> nm_;                  ///< wavelengths of the bands, if all are fixed; else empty
  std::vector<float> listed_nm_;           ///< the same, ascending
  std::vector<ResponseSampler> samplers_;  ///< one for each band with a response
  Interval range_nm_{};
};

}  // namespace

extern const WavelengthsInfo bands_wavelengths{
    {"wavelengths", "bands",
     "Bands at any wavelengths or with the responses of a sensor, from 300 to 2500 nm, as channels of an EXR file.",
     "Imaging spectrometers", kBandsParams},
    [](const Params& p) -> std::unique_ptr<WavelengthStrategy> { return std::make_unique<Bands>(p); }};

}  // namespace frond
