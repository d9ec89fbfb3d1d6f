#include "study/compare/bands_chart.h"

#include <algorithm>

#include "report/gnuplot.h"
#include "study/compare/curve_style.h"

namespace frond::compare {
namespace {

struct BandError {
  double nm, bias, low, high, noise;

  /// With 97.5 % confidence.
  bool is_biased() const { return low > 0; }
};

/// As the axis has them.
std::vector<BandError> band_errors(const Subject& subject, const ChannelList& channels, const ErrorUnit& unit) {
  std::vector<BandError> errors;
  const auto& all = subject.rungs.back().errors[kAll];
  for (size_t b = 0; b < channels.bands.size(); ++b) {
    const RenderError& e = all[kFirst + b];
    errors.push_back({channels.bands[b].nm, unit.on_axis(e.bias.root()), unit.on_axis(e.bias.root_at(-kZ95)),
                      unit.on_axis(e.bias.root_at(kZ95)), unit.on_axis(e.noise.root())});
  }
  return errors;
}

std::string number_or_none(bool there, double v) { return there ? fmt::format("{}", v) : "NaN"; }

/// What is below the axis ends at it.
std::string data_block(size_t i, const std::vector<BandError>& errors, const AxisRange& y) {
  std::string text = fmt::format("$b{} << EOD\n", i);
  for (const BandError& e : errors)
    text += fmt::format("{} {} {} {} {}\n", e.nm, number_or_none(e.is_biased(), e.bias), std::max(e.low, y.low),
                        std::max(e.high, y.low), number_or_none(e.noise > 0, e.noise));
  return text + "EOD\n";
}

/// `aside` (nm) keeps candidates' bars off each other.
std::string curve(size_t i, double aside, const std::string& label) {
  return fmt::format(
      "$b{0} using 1:5 with lines lc rgb '{1}' dt 3 lw 2 notitle, "
      "$b{0} using ($1+{2}):3:(0):($4-$3) with vectors nohead lc rgb '{1}' lw 1.2 notitle, "
      "$b{0} using ($1+{2}):2 with linespoints {3} pt {4} ps 0.7 lw 2 title {5}, ",
      i, kSeriesColors[i], aside, line_style(i), kPoints[i], gnuplot_text(label));
}

/// An entry of the key.
std::string bars_explained() {
  return "NaN with points pt '|' lc rgb '#000000' "
         "title 'bars: intervals of 95 %; without a mark the bias is not told from none', ";
}

/// The range of wavelengths, with room for what stands aside.
std::string wavelength_axis(const ChannelList& channels, double step_nm) {
  return fmt::format("set xlabel 'wavelength (nm)'\nset xrange [{}:{}]\n", channels.bands.front().nm - step_nm,
                     channels.bands.back().nm + step_nm);
}

double mean_step_nm(const ChannelList& channels) {
  const size_t count = channels.bands.size();
  return count < 2 ? 10 : (channels.bands.back().nm - channels.bands.front().nm) / double(count - 1);
}

}  // namespace

std::string bands_chart(const Comparison& c) {
  const ErrorUnit unit = c.request.error_unit();
  std::vector<std::vector<BandError>> all;
  AxisRange y;
  for (const Subject& s : c.subjects) {
    all.push_back(band_errors(s, c.channels, unit));
    for (const BandError& e : all.back())
      for (const double v : {e.low, e.high, e.noise})
        if (v > 0) y.include(v);
  }
  if (!(y.high > 0)) return "";
  y.low = std::max(y.low, y.high / 1e4);
  y = y.widened();
  const double step_nm = mean_step_nm(c.channels);
  std::string script = chart_frame() + wavelength_axis(c.channels, step_nm), plot;
  for (size_t i = 0; i < all.size(); ++i) {
    script += data_block(i, all[i], y);
    plot += curve(i, step_nm * 0.5 * ((double(i) + 0.5) / double(all.size()) - 0.5), c.subjects[i].candidate.label);
  }
  return script + log_axis('y', y, fmt::format("bias and noise ({})", unit.of_axis(c.channels))) +
         key_below(all.size() + 2) + "plot " + plot + bars_explained() +
         fmt::format("NaN with lines lc rgb '#000000' dt 3 lw 2 title 'noise of one render of {} samples'\n",
                     c.subjects.front().rungs.back().samples);
}

}  // namespace frond::compare
