#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "cli/interrupt.h"
#include "core/log.h"
#include "render/checkpoint.h"

namespace frond {

/// What a command has done so far, in a file that --resume goes on from. While it lives no other program may work on
/// the file, and the first SIGINT or SIGTERM asks for a stop, so that what is done by then can be kept.
class KeptFile {
 public:
  struct Names {
    std::filesystem::path finished;    ///< what is complete
    std::filesystem::path checkpoint;  ///< what is not; may be the same
  };
  static constexpr double kSeconds = 60;  ///< from one checkpoint to the next, where nothing is said

  /// Throws Busy.
  KeptFile(Names names, const Log& log) : names_(std::move(names)), log_(log), lock_(names_.finished) {}

  /// What an earlier run has left. Throws InputError where there is something and `resume` is not asked for.
  std::optional<std::filesystem::path> found(bool resume) const;
  std::stop_token stop() const { return interrupt_.token(); }
  bool was_stopped() const { return interrupt_.signal() != 0; }
  const std::filesystem::path& checkpoint() const { return names_.checkpoint; }
  /// What is done at the end, by `write`, which is told where. Where all of it is done, a write that fails is a
  /// warning, unless the file is the result itself.
  void keep(bool is_complete, bool is_result, const std::function<void(const std::filesystem::path&)>& write) const;
  /// Tells people, who have stopped the command. Returns the program's exit code.
  int say_how_to_go_on() const;

 private:
  Names names_;
  const Log& log_;
  PartLock lock_;
  Interrupt interrupt_;
};

}  // namespace frond
