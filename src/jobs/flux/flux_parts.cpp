#include "jobs/flux/flux_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/stop.h"
#include "jobs/support/radiometry.h"

namespace frond {

FluxParts::FluxParts(const JobRun& run) : run_(run) {
  for (const std::string& path : run.args.texts("merge")) merged_.emplace_back(path, read_sums(path));
  const auto names = kept_names_of(run.args);
  if (!names) return;
  file_.emplace(*names, run.control.stop, run.log());
  if (const auto path = file_->found(run.args.flag("resume"))) found_ = read_sums(*path), found_name_ = path->string();
}

void FluxParts::begin(FluxMeter& meter, SampleRange paths) {
  const size_t scene = scenes_.size();
  scenes_.emplace_back();
  meter.start_at(paths.begin);
  if (scene >= found_.size()) return;
  const SumsPart& part = found_[scene];
  if (part.begin != paths.begin || (writes_part() && part.end > paths.end))
    fail({}, "{}: \"{}\" has other paths than this command requests", run_.args.spelled("resume"), found_name_);
  const UnstoppableScope whole;
  meter.add(part, found_name_);
}

std::function<void()> FluxParts::checkpoint(const FluxMeter& meter) {
  if (!file_) return {};
  using Clock = std::chrono::steady_clock;
  const std::chrono::duration<double> interval(checkpoint_seconds(run_.args));
  return [this, &meter, interval, last = Clock::now()]() mutable {
    if (Clock::now() - last < interval) return;
    end(meter);
    const UnstoppableScope whole;
    try {
      write_sums(file_->checkpoint(), scenes_);
    } catch (const InputError& error) {
      run_.log().warn({}, fmt::format("no checkpoint was written; the measurement continues: {}", error.what()));
    }
    last = Clock::now();
  };
}

/// A stop does not end it: the identity reads files.
void FluxParts::end(const FluxMeter& meter) {
  const UnstoppableScope whole;
  if (file_) scenes_.back() = meter.part();
}

Result FluxParts::finish(bool is_complete) {
  if (!file_) return {.stopped = !is_complete};
  file_->keep(is_complete, writes_part(), [this](const auto& path) { write_sums(path, scenes_); });
  if (!is_complete) file_->report_stop();
  return {.stopped = !is_complete};
}

/// Empty parts, of ranges shorter than a block, have no paths to compare.
void FluxParts::merge(FluxMeter& meter, uint64_t paths) {
  const size_t scene = next_++;
  std::vector<std::pair<const SumsPart*, std::string>> parts;
  for (const auto& [path, scenes] : merged_) {
    if (scene >= scenes.size())
      fail({}, "\"{}\" is a part of another measurement, or incomplete: it has {} scenes or times", path,
           scenes.size());
    parts.emplace_back(&scenes[scene], path);
  }
  std::ranges::stable_sort(parts, {}, [](const auto& part) { return part.first->begin; });
  const std::string* before = nullptr;
  const auto fail_missing = [](uint64_t begin, uint64_t end) {
    fail({}, "no part has the paths {}:{}: measure them, or all of them with one number of paths", begin, end);
  };
  for (const auto& [part, path] : parts) {
    if (part->begin < meter.end() && part->begin < part->end)
      fail({}, "\"{}\" and \"{}\" both have paths {}:{}: each path counts once", *before, path, part->begin,
           std::min(meter.end(), part->end));
    if (part->begin > meter.end()) fail_missing(meter.end(), part->begin);
    meter.add(*part, path);
    before = &path;
  }
  if (meter.end() < paths) fail_missing(meter.end(), paths);
}

}  // namespace frond
