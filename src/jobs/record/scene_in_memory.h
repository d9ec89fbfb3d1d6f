#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/messages/problems.h"
#include "jobs/record/arguments.h"
#include "scene/format/description.h"

namespace frond {

struct JobRun;

/// A file as it was when a scene was loaded.
struct FileState {
  std::filesystem::path path;
  std::uintmax_t size = 0;
  std::filesystem::file_time_type time = {};
};

/// A scene that Python has loaded. The objects that it refers to must outlive it.
struct SceneInMemory {
  std::string name;                ///< its file, or what errors call its text
  const SceneSettings& settings;   ///< as they were read, without overrides
  const SceneDescription& shapes;  ///< description with its shapes, objects and instances
  const Arguments& arguments;      ///< of the job `render`, which override the settings
  bool has_bands = false;          ///< whether its wavelengths are bands
  std::vector<FileState> files;    ///< that the settings and shapes name, such as meshes and spectra
};

/// A scene in memory that a job is given in place of a file.
struct GivenScene {
  SceneInMemory scene;
  Arguments overrides;  ///< arguments of the scene that the job has no parameter for: they are written into the scene
};

/// The scene of a job: files, or a scene in memory, of which `files` is the name.
struct SceneInput {
  std::vector<std::filesystem::path> files;
  const GivenScene* given = nullptr;
};

/// Returns the sizes and times of the files, without those that do not exist.
std::vector<FileState> states_of(const std::vector<std::filesystem::path>& files);

/// Returns the scenes, by the index of their words. If there is one, adds to `args` the arguments that it was loaded
/// with, except for parameters that the job lacks or that are given.
std::map<size_t, GivenScene> given_scenes(const std::map<size_t, SceneInMemory>& scenes, Arguments& args);

/// Returns the scenes of a parameter. A scene may consist of several files, the last of which contains WorldBegin.
std::vector<SceneInput> scenes_of(const JobRun& run, std::string_view name = "scene");

/// Reads a scene, or copies one in memory and applies the overrides that the job has no parameter for. Errors are added
/// to `problems`, also if a file that a scene in memory names has changed since it was loaded.
SceneDescription read_scene(const JobRun& run, const SceneInput& input, Problems& problems);
/// Same; throws all errors together.
SceneDescription read_scene(const JobRun& run, const SceneInput& input);

}  // namespace frond
