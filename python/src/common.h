#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>

#include "jobs/record/job.h"

namespace frond::python {

namespace nb = nanobind;

/// Messages go to the logger "frond" of the module `logging`.
class PythonLog final : public Log {
 public:
  PythonLog();
  ~PythonLog() override;
  PythonLog(const PythonLog&) = delete;
  PythonLog& operator=(const PythonLog&) = delete;

  void info(std::string_view message) const override { say("info", std::string(message)); }
  void warn(const Location& where, std::string_view message) const override;

 private:
  void say(const char* level, const std::string& text) const;

  nb::object logger_;
};

/// A session of Python's, with its log.
struct SessionHandle {
  explicit SessionHandle(SessionOptions options) : context(log, std::move(options)) { context.session(); }
  Session& session() { return context.session(); }

  PythonLog log;
  JobContext context;
};

/// Arguments of a job, by name: one text for each time that a parameter is given.
using GivenArguments = std::map<std::string, std::vector<std::string>>;
/// Throws InputError.
Arguments arguments_of(const JobInfo& job, const GivenArguments& given);

/// A NumPy array that owns its values.
template <class T>
nb::ndarray<nb::numpy, T> to_array(std::vector<T> values, std::vector<size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::ndarray<nb::numpy, T>(kept->data(), shape.size(), shape.data(), owner);
}

/// Directions, one a row: unit vectors in the local frame.
using Directions = nb::ndarray<const float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

/// Throws the exception of a signal's Python handler, such as KeyboardInterrupt, if a signal has arrived. Takes the
/// GIL.
void check_signals();

/// Runs `work` without the GIL on a thread of its own, and meanwhile checks for signals and calls `progress` (None, or
/// a function of the share that is done) some ten times a second. An exception of either stops the work, and is thrown
/// here once it has ended.
void run(const std::function<void(const RenderControl&)>& work, const nb::object& progress);

void bind_session(nb::module_& m);
void bind_jobs(nb::module_& m);
void bind_bsdf(nb::module_& m);
void bind_python_bsdf(nb::module_& m);
void bind_leaf(nb::module_& m);

}  // namespace frond::python
