#include "system/file_uses.h"

#include <sys/stat.h>

#include <algorithm>
#include <compare>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

namespace frond {
namespace {

namespace fs = std::filesystem;

struct Identity {
  dev_t device;
  ino_t inode;
  friend auto operator<=>(const Identity&, const Identity&) = default;
};

std::optional<Identity> identity_of(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {};
  return Identity{status.st_dev, status.st_ino};
}

struct Output {
  const PlannedOutput* owner;
  std::string name, path;
  std::optional<Identity> identity;  ///< of the file that is replaced, if there is one
  bool is_readable = false;
};

struct Uses {
  std::vector<Output> outputs;
  std::map<Identity, std::string> reads;
};

std::mutex mutex;
/// Uses by running job; Python runs several jobs at once.
std::map<const FileUses*, Uses> jobs;
thread_local FileUses* current = nullptr;

/// Calls `act` for the thread's job, or for all if the thread belongs to none: it may be one of a thread pool.
template <class Act>
void for_jobs(const Act& act) {
  const std::lock_guard lock(mutex);
  for (auto& [job, uses] : jobs)
    if (!current || job == current) act(uses);
}

/// Returns the name of the input that `output` would replace, or nullptr. An inode that was noted may be another file's
/// by now.
const std::string* replaced_input(const Uses& uses, const fs::path& output, const std::optional<Identity>& identity) {
  if (!identity) return nullptr;
  const auto read = uses.reads.find(*identity);
  return read != uses.reads.end() && is_same_file(read->second, output) ? &read->second : nullptr;
}

}  // namespace

/// The path is made absolute first, because weakly_canonical returns a relative path unchanged if no part of it exists.
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::exists(a, error) || fs::exists(b, error)) return fs::equivalent(a, b, error) && !error;
  const auto full = [&error](const fs::path& path) { return fs::weakly_canonical(fs::absolute(path, error), error); };
  return full(a) == full(b) && !error;
}

void check_file_name(std::string_view path, std::string_view what, const Location& where) {
  if (path.size() > 1 && path.starts_with('-'))
    fail(where, "{}: \"{}\" begins with -, as options do: if it is a file, write ./{}", what, path, path);
}

FileUses::FileUses() : outer_(current) {
  const std::lock_guard lock(mutex);
  jobs[this];
  current = this;
}

FileUses::~FileUses() {
  const std::lock_guard lock(mutex);
  jobs.erase(this);
  current = outer_;
}

PlannedOutput::PlannedOutput(std::string name, std::string path, const Location& where) : job_(current) {
  if (!job_) return;
  const std::lock_guard lock(mutex);
  Uses& uses = jobs[job_];
  const bool is_printed = path == "-";
  for (const Output& other : uses.outputs) {
    if (is_printed != (other.path == "-")) continue;
    if (is_printed) fail(where, "only one of {} and {} can go to standard output", other.name, name);
    if (is_same_file(path, other.path)) fail(where, "{} and {} write to the same file, \"{}\"", other.name, name, path);
  }
  const auto identity = is_printed ? std::nullopt : identity_of(path);
  if (const std::string* input = replaced_input(uses, path, identity))
    fail(where, "{} would replace the input \"{}\"", name, *input);
  uses.outputs.push_back({this, std::move(name), std::move(path), identity});
}

PlannedOutput::~PlannedOutput() {
  if (!job_) return;
  const std::lock_guard lock(mutex);
  if (const auto job = jobs.find(job_); job != jobs.end())
    std::erase_if(job->second.outputs, [this](const Output& o) { return o.owner == this; });
}

void record_read(const fs::path& path, const Location& where) {
  const auto identity = identity_of(path);
  if (!identity) return;
  for_jobs([&](Uses& uses) {
    for (const Output& o : uses.outputs)
      if (o.identity == identity && !o.is_readable && is_same_file(path, o.path))
        fail(where, "{} would replace the input \"{}\"", o.name, path.string());
    uses.reads.emplace(*identity, path.string());
  });
}

void allow_reading(const fs::path& output) {
  for_jobs([&](Uses& uses) {
    for (Output& o : uses.outputs)
      if (is_same_file(output, o.path)) o.is_readable = true;
  });
}

}  // namespace frond
