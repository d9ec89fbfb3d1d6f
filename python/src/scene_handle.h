#pragma once

#include "common.h"
#include "jobs/support/render_task.h"

namespace frond::python {

/// A scene, loaded as the arguments of the job `render` ask for it.
struct SceneHandle {
  SceneHandle(std::shared_ptr<SessionHandle> session, Arguments given, bool adaptive)
      : owner(std::move(session)), args(std::move(given)), run{owner->context, args}, task(run, adaptive) {}

  /// Returns what other jobs take the scene from. It refers to this object.
  SceneInMemory in_memory() const {
    return {args.words("scene").front(),
            task.settings(),
            task.scene().description(),
            args,
            !task.scene().scene().wavelengths().bands().empty(),
            files};
  }

  std::shared_ptr<SessionHandle> owner;
  Arguments args;
  JobRun run;
  RenderTask task;
  std::vector<FileState> files = {};  ///< that the scene names
};

}  // namespace frond::python
