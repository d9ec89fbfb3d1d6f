#include <condition_variable>
#include <mutex>
#include <thread>

#include "common.h"

namespace frond::python {

PythonLog::PythonLog() : logger_(nb::module_::import_("logging").attr("getLogger")("frond")) {}

PythonLog::~PythonLog() {
  const nb::gil_scoped_acquire hold;
  logger_.reset();
}

void PythonLog::warn(const Location& where, std::string_view message) const {
  say("warning", InputError(where, std::string(message)).what());
}

void PythonLog::say(const char* level, const std::string& text) const {
  const nb::gil_scoped_acquire hold;
  logger_.attr(level)("%s", text);
}

void check_signals() {
  const nb::gil_scoped_acquire hold;
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
}

namespace {

/// Progress of the work, for another thread.
class Watch final : public Progress {
 public:
  void update(double fraction, const RenderStatistics&) override { fraction_ = fraction; }
  double fraction() const { return fraction_; }

 private:
  std::atomic<double> fraction_ = 0;
};

}  // namespace

void run(const std::function<void(const RenderControl&)>& work, const nb::object& progress) {
  using namespace std::chrono_literals;
  Watch watch;
  std::stop_source stop;
  std::mutex mutex;
  std::condition_variable ended;
  bool is_done = false;
  std::exception_ptr failure;    // of the work
  std::exception_ptr interrupt;  // of a signal, or of `progress`
  {
    const nb::gil_scoped_release release;
    const std::jthread worker([&] {
      try {
        RenderControl control;
        control.stop = stop.get_token(), control.progress = &watch;
        work(control);
      } catch (...) {
        failure = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      is_done = true;
      ended.notify_all();
    });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, 100ms, [&] { return is_done; })) {
      if (interrupt) continue;
      lock.unlock();
      try {
        check_signals();
        const nb::gil_scoped_acquire hold;
        if (!progress.is_none()) progress(watch.fraction());
      } catch (...) {
        interrupt = std::current_exception();
        stop.request_stop();
      }
      lock.lock();
    }
  }
  if (interrupt) std::rethrow_exception(interrupt);
  if (failure) std::rethrow_exception(failure);
  if (!progress.is_none()) progress(1.0);
}

NB_MODULE(_frond, m) {
  m.doc() = "Bindings of frond: what the package frond is made of.";
  nb::set_leak_warnings(false);  // the default session lives as long as the process
  // Its places and its list of problems are read from its text (frond/errors.py).
  const nb::object error = nb::module_::import_("frond._errors").attr("InputError");
  nb::register_exception_translator(
      [](const std::exception_ptr& p, void* type) {
        try {
          std::rethrow_exception(p);
        } catch (const InputErrors& errors) {
          const nb::object value = nb::borrow(static_cast<PyObject*>(type)).attr("_of")(errors.messages());
          PyErr_SetObject(static_cast<PyObject*>(type), value.ptr());
        } catch (const InputError& e) {
          const nb::object value =
              nb::borrow(static_cast<PyObject*>(type)).attr("_of")(std::vector<std::string>{e.what()});
          PyErr_SetObject(static_cast<PyObject*>(type), value.ptr());
        }
      },
      nb::object(error).release().ptr());
  m.attr("version") = FROND_VERSION;
  bind_jobs(m);
  bind_session(m);
  bind_bsdf(m);
  bind_python_bsdf(m);
  bind_leaf(m);
}

}  // namespace frond::python
