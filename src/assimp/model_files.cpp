#include "assimp/model_files.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "imports/gltf_check.h"
#include "imports/obj_lines.h"
#include "imports/obj_origin.h"
#include "imports/uri.h"

namespace frond {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMegabyte = 1'000'000, kGigabyte = 1'000'000'000, kLargestFile = 4 * kGigabyte;

/// Returns the size of the machine's memory, bytes.
uint64_t machine_memory() { return uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE)); }

/// The soft limit, which this process may raise again; never above the limit that it was started with.
void set_limit(decltype(RLIMIT_AS) what, uint64_t value) {
  rlimit limit{};
  getrlimit(what, &limit);
  limit.rlim_cur = std::min<rlim_t>(value, limit.rlim_max);
  setrlimit(what, &limit);
}

/// A file that is open for reading. The library asks for its size first, and reads all of it.
class ReadStream final : public Assimp::IOStream {
 public:
  ReadStream(FILE* file, size_t size) : file_(file, &std::fclose), size_(size) {}

  size_t Read(void* to, size_t size, size_t count) override { return std::fread(to, size, count, file_.get()); }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const int from = origin == aiOrigin_SET ? SEEK_SET : origin == aiOrigin_CUR ? SEEK_CUR : SEEK_END;
    return std::fseek(file_.get(), long(offset), from) == 0 ? aiReturn_SUCCESS : aiReturn_FAILURE;
  }
  size_t Tell() const override { return size_t(std::ftell(file_.get())); }
  size_t FileSize() const override { return size_; }
  void Flush() override {}

 private:
  std::unique_ptr<FILE, int (*)(FILE*)> file_;
  size_t size_;
};

/// A text in memory, which outlives the stream.
class TextStream final : public Assimp::IOStream {
 public:
  explicit TextStream(std::string_view text) : text_(text) {}

  size_t Read(void* to, size_t size, size_t count) override {
    const size_t whole = size == 0 ? 0 : std::min(count, (text_.size() - at_) / size);
    std::memcpy(to, text_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : text_.size();
    if (offset > text_.size() - from) return aiReturn_FAILURE;
    at_ = from + offset;
    return aiReturn_SUCCESS;
  }
  size_t Tell() const override { return at_; }
  size_t FileSize() const override { return text_.size(); }
  void Flush() override {}

 private:
  std::string_view text_;
  size_t at_ = 0;
};

}  // namespace

/// No core dump, and few open files.
ProcessLimits::ProcessLimits() : memory_(kGigabyte), most_memory_(machine_memory()) {
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_NOFILE, 64);
  apply();
}

/// A text of n bytes becomes at most some 100 n bytes of vertices, faces and their copies while they are prepared.
void ProcessLimits::allow_file(uint64_t bytes) {
  memory_ += 128 * bytes;
  seconds_ += 2 * bytes / kMegabyte;
  apply();
}

/// Applies to this process from now on; memory beyond the limit is std::bad_alloc, time beyond it SIGXCPU.
void ProcessLimits::apply() const {
  const uint64_t memory = std::min(memory_, most_memory_);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which reserve terabytes of addresses
  set_limit(RLIMIT_AS, memory);
#endif
  set_limit(RLIMIT_FSIZE, 4 * memory);  // standard output, a file
  set_limit(RLIMIT_CPU, seconds_);
}

ModelFiles::ModelFiles(const fs::path& model, ProcessLimits& limits)
    : folder_(fs::canonical(model).parent_path()),
      model_(fs::canonical(model)),
      is_obj_(lower_case(model.extension().string()) == ".obj"),
      limits_(limits) {}

void ModelFiles::allow(const fs::path& path) {
  if (allowed_.insert(path).second) limits_.allow_file(fs::file_size(path));
}

std::string ModelFiles::content(const fs::path& path) {
  const std::unique_ptr<FILE, int (*)(FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw std::runtime_error("\"" + path.filename().string() + "\" cannot be opened");
  allow(path);
  std::string bytes(fs::file_size(path), '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  return bytes;
}

const std::string& ModelFiles::obj_text(const fs::path& path) {
  const auto [entry, is_new] = texts_.try_emplace(path);
  std::string problem;
  const auto is_usable = [&](const std::string& name) { return !permitted(name.c_str(), &problem).empty(); };
  if (is_new && path == model_) {
    entry->second = obj_.model(content(path), is_usable);
    origin_ = move_obj_to_origin(entry->second);
  } else if (is_new) {
    entry->second = obj_.materials(content(path));
  }
  return entry->second;
}

void ModelFiles::check() {
  if (is_obj_)
    obj_text(model_);
  else
    gltf_losses_ = check_gltf(content(model_));
}

/// The path is relative to the model's folder, or begins with it. Windows' separators are accepted.
fs::path ModelFiles::permitted(const char* name, std::string* problem) const {
  std::string text = name;
  std::ranges::replace(text, '\\', '/');
  std::error_code error;
  fs::path path = fs::canonical(folder_ / text, error);
  if (error && !is_obj_) path = fs::canonical(folder_ / percent_decoded(text), error);
  if (error) {
    *problem = "there is no such file";
    return {};
  }
  const auto [end, other] = std::ranges::mismatch(folder_, path);
  if (end != folder_.end()) {
    *problem = "it is outside the model's folder; put it there and change the path in the model";
    return {};
  }
  const uint64_t size = fs::is_regular_file(path, error) ? fs::file_size(path, error) : 0;
  if (error || !fs::is_regular_file(path)) {
    *problem = "it is no regular file";
    return {};
  }
  if (size > kLargestFile) {
    *problem = "it is larger than 4 GB";
    return {};
  }
  return path;
}

/// Asked for before a file is opened; no message, because the library tries several names.
bool ModelFiles::Exists(const char* name) const {
  std::string problem;
  return !permitted(name, &problem).empty();
}

/// Stores a message. A hostile file may name any number of files, with names of any length.
void ModelFiles::reject(const char* name, const std::string& problem) {
  constexpr size_t kLongest = 200, kMost = 20;  // of messages
  const std::string message = "\"" + std::string(name).substr(0, kLongest) + "\" is not read: " + problem;
  if (refusals_.size() < kMost && std::ranges::find(refusals_, message) == refusals_.end())
    refusals_.push_back(message);
}

/// The limits grow with each file before it is read.
Assimp::IOStream* ModelFiles::Open(const char* name, const char* mode) {
  std::string problem;
  const fs::path path = permitted(name, &problem);
  // Name that the library tries if a material file is missing, which has been reported already.
  const bool is_fallback = is_obj_ && name == fs::path(model_.filename()).replace_extension(".mtl");
  if (!problem.empty() && is_fallback && !refusals_.empty()) return nullptr;
  FILE* file = nullptr;
  if (problem.empty() && *mode != 'r') problem = "files are not written";
  if (problem.empty() && !(file = std::fopen(path.c_str(), "rb"))) problem = "it cannot be opened";
  if (!problem.empty()) {
    reject(name, problem);
    return nullptr;
  }
  if (is_obj_) {
    std::fclose(file);
    return new TextStream(obj_text(path));
  }
  allow(path);
  return new ReadStream(file, fs::file_size(path));
}

void ModelFiles::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace frond
