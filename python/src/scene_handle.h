#pragma once

#include "common.h"
#include "jobs/support/render_task.h"

namespace frond::python {

/// A scene, loaded with arguments of the job `render`.
struct SceneHandle {
  SceneHandle(std::shared_ptr<SessionHandle> session, Arguments given, bool adaptive)
      : owner(std::move(session)), args(std::move(given)), run{owner->context, args}, task(run, adaptive) {}

  /// Returns the scene for other jobs. It refers to this object.
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
