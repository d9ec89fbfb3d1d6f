#include "render/checkpoint.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>

#include "core/error.h"
#include "render/parts/part_file.h"

namespace frond {
namespace {

/// True if `path` is still the name of the open file. Another process may have deleted or replaced the file, and then a
/// lock on it has no effect.
bool is_name_of(int descriptor, const std::filesystem::path& path) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

}  // namespace

PartLock::PartLock(const std::filesystem::path& part) : path_(part) {
  path_ += ".lock";
  for (;;) {
    descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail({}, "cannot write \"{}\": {}", path_.string(), std::strerror(errno));
    const bool has_lock = flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    if (!has_lock && errno != EWOULDBLOCK) return;  // some file systems have no locks
    if (has_lock && is_name_of(descriptor_, path_)) return;
    close(descriptor_);
    if (!has_lock)
      throw Busy(
          fmt::format("another frond process is writing \"{}\": wait for it, or name another output", part.string()));
  }
}

PartLock::~PartLock() {
  unlink(path_.c_str());
  close(descriptor_);
}

Checkpointer::Checkpointer(std::filesystem::path path, double seconds, const RenderPart& part, Progress* next,
                           const Log& log)
    : path_(std::move(path)),
      seconds_(seconds),
      film_(part.film),
      header_(part.header),
      next_(next),
      log_(log),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Checkpointer::~Checkpointer() = default;

void Checkpointer::update(double fraction, const RenderStatistics& so_far) {
  {
    const std::lock_guard lock(mutex_);
    so_far_ = so_far;
  }
  if (next_) next_->update(fraction, so_far);
}

void Checkpointer::finish() {
  if (next_) next_->finish();
}

void Checkpointer::write() {
  const std::lock_guard one_at_a_time(writing_);
  PartHeader header;
  {
    const std::lock_guard lock(mutex_);
    header = header_;
    header.statistics += so_far_;
  }
  write_part(path_, header, film_);
}

void Checkpointer::change_part(const std::function<void()>& change, const PartHeader& header) {
  // Waits for a checkpoint in progress: it has the old header and must not contain anything of the new plan.
  const std::scoped_lock lock(writing_, mutex_);
  change();
  header_ = header;
  so_far_ = {};
}

void Checkpointer::run(const std::stop_token& stop) {
  std::mutex none;
  std::unique_lock lock(none);
  const auto interval = std::chrono::duration<double>(seconds_);
  while (!ended_.wait_for(lock, stop, interval, [&stop] { return stop.stop_requested(); })) {
    if (stop.stop_requested()) return;
    try {
      write();
    } catch (const std::exception& error) {
      log_.warn({}, fmt::format("no checkpoint was written, rendering goes on: {}", error.what()));
    }
  }
}

}  // namespace frond
