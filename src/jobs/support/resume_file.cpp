#include "jobs/support/resume_file.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/stop.h"

namespace frond {

ResumeFile::ResumeFile(Names names, std::stop_token stop, const Log& log)
    : names_(std::move(names)),
      stop_(std::move(stop)),
      log_(log),
      output_("the checkpoint", names_.checkpoint),
      lock_output_("its lock", names_.finished.string() + ".lock"),
      lock_(names_.finished) {}

/// A complete result takes precedence over a checkpoint.
std::optional<std::filesystem::path> ResumeFile::found(bool resume) const {
  std::error_code error;
  const auto& path = std::filesystem::exists(names_.finished, error) ? names_.finished : names_.checkpoint;
  if (!std::filesystem::exists(path, error)) return {};
  if (!resume) fail({}, "\"{}\" already exists: --resume continues from it; delete it to start again", path.string());
  allow_reading(path);
  return path;
}

/// The checkpoint is removed only after the complete result has been written. A stop does not end the writing.
void ResumeFile::keep(bool is_complete, bool is_result,
                      const std::function<void(const std::filesystem::path&)>& write) const try {
  const UnstoppableScope whole;
  write(is_complete ? names_.finished : names_.checkpoint);
  std::error_code ignored;  // a name that is too long, for example: then there is no checkpoint
  if (is_complete && names_.checkpoint != names_.finished) std::filesystem::remove(names_.checkpoint, ignored);
} catch (const InputError& error) {
  if (!is_complete || is_result) throw;
  log_.warn({}, fmt::format("no checkpoint was written: {}", error.what()));
}

void ResumeFile::report_stop() const {
  log_.info(fmt::format("stopped; the partial result is in {}: the same command with --resume goes on from there",
                        names_.checkpoint.string()));
}

double checkpoint_seconds(const Arguments& args) {
  constexpr double kDefault = 60;
  return args.given("checkpoint") ? args.real("checkpoint") : kDefault;
}

}  // namespace frond
