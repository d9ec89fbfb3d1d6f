#include "render/checkpoint.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>

#include "core/error.h"
#include "render/part_file.h"

namespace frond {

PartLock::PartLock(const std::filesystem::path& part) : path_(part) {
  path_ += ".lock";
  descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail({}, "cannot write \"{}\": {}", path_.string(), std::strerror(errno));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;  // some file systems have no locks
  close(descriptor_);
  throw Busy(fmt::format("another frond is at work on \"{}\": wait for it, or name another output", part.string()));
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
      thread_([this](std::stop_token stop) { run(stop); }) {}

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

void Checkpointer::set_header(const PartHeader& header) {
  const std::lock_guard lock(mutex_);
  header_ = header;
  so_far_ = {};
}

void Checkpointer::run(std::stop_token stop) {
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
