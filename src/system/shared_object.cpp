#include "system/shared_object.h"

#include <dlfcn.h>

#include <string>

namespace frond {
namespace {

namespace fs = std::filesystem;

/// Returns the reason why the last call of the loader failed.
std::string loader_error() {
  const char* text = dlerror();
  return text ? text : "unknown reason";
}

}  // namespace

SharedObject::SharedObject(const fs::path& file, std::string_view what, Binding binding) {
  std::error_code error;
  if (!fs::exists(file, error)) fail({}, "{} \"{}\": there is no such file", what, file.string());
  // An absolute path, because the loader searches for a bare name in its own folders.
  handle_ = dlopen(fs::absolute(file).c_str(), (binding == Binding::now ? RTLD_NOW : RTLD_LAZY) | RTLD_LOCAL);
  if (handle_) return;
  const std::string reason = loader_error();
  const bool lacks_symbol = reason.find("undefined symbol") != std::string::npos;
  fail({}, "{} \"{}\" cannot be loaded: {}{}", what, file.string(), reason,
       lacks_symbol ? "; it uses what this frond does not export, or was built for another one" : "");
}

void* SharedObject::symbol(const char* name) const { return dlsym(handle_, name); }

fs::path own_file() {
  Dl_info info;
  static const char kHere = 0;
  if (dladdr(&kHere, &info) == 0 || !info.dli_fname) return "/proc/self/exe";
  std::error_code error;
  const auto path = fs::canonical(info.dli_fname, error);
  return error ? fs::path("/proc/self/exe") : path;  // for a program, dli_fname is the name of its command
}

}  // namespace frond
