#pragma once

#include "cli/specimen_options.h"
#include "core/log.h"
#include "core/parallel.h"
#include "instruments/beam.h"
#include "instruments/rays.h"
#include "render/measured_material.h"

namespace frond {

/// What both instruments are told on the command line.
struct InstrumentOptions : SpecimenOptions {
  std::vector<std::string> angles = {"8"}, wavelengths;
  std::string rays, csv, json, plot;
  bool as_rendered = false;
};

void add_instrument_options(CLI::App& command, InstrumentOptions& options);

/// A bench with everything on it: made before the first ray is shot, so that what is wrong is told at once.
class InstrumentBench {
 public:
  /// Throws InputError for lists, names, parameters, angles and wavelengths that are wrong, for outputs that cannot
  /// be written, and for materials that are not there or, as rendered, have a delta lobe.
  explicit InstrumentBench(const InstrumentOptions& options);

  const ThreadPool& pool() const { return pool_; }
  const Log& log() const { return log_; }
  const std::vector<double>& angles_deg() const { return angles_deg_; }
  const std::vector<double>& wavelengths_nm() const { return wavelengths_nm_; }
  const std::vector<MeasuredMaterial>& specimens() const { return specimens_; }
  size_t size() const { return specimens_.size() * angles_deg_.size() * wavelengths_nm_.size(); }

  /// Exposure number i: wavelengths run fastest, then angles, then specimens. Random numbers differ from one to the
  /// next, by material, angle and wavelength, not by place in the list.
  Exposure exposure(size_t i) const;
  const MeasuredMaterial& specimen(size_t i) const {
    return specimens_[i / (angles_deg_.size() * wavelengths_nm_.size())];
  }

 private:
  void check_exposures() const;

  ThreadPool pool_;
  ConsoleLog log_;
  uint64_t seed_;
  bool as_rendered_;
  std::vector<double> angles_deg_, wavelengths_nm_;
  std::vector<MeasuredMaterial> specimens_;
};

/// Tells on a terminal how far a list of exposures is.
class InstrumentProgress {
 public:
  InstrumentProgress(size_t exposures, int64_t rays_each, bool quiet);
  ~InstrumentProgress();
  InstrumentProgress(const InstrumentProgress&) = delete;
  InstrumentProgress& operator=(const InstrumentProgress&) = delete;

  void start(size_t exposure) { exposure_ = exposure; }
  void operator()(int64_t rays);

 private:
  struct State;
  std::unique_ptr<State> state_;
  size_t exposures_, exposure_ = 0;
  int64_t rays_each_;
};

/// The lines that begin every file an instrument writes: who measured what, and which way the light went.
std::vector<std::string> instrument_notes(const std::string& instrument, const InstrumentOptions& options,
                                          const InstrumentBench& bench);

}  // namespace frond
