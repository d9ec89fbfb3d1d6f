#pragma once

#include <filesystem>
#include <string_view>

#include "core/error.h"

namespace frond {

/// A shared object, opened while the program runs. It is never closed: what it made points into it.
class SharedObject {
 public:
  /// When its calls are bound: now, so that nothing which is missing is found out in the middle of a render; or each
  /// when it is first made, which takes less time.
  enum class Binding { now, lazy };

  /// Throws InputError, which calls it `what`: there is no such file, or the loader refuses it.
  SharedObject(const std::filesystem::path& file, std::string_view what, Binding binding);

  /// An exported function (extern "C"), nullptr where there is none of that name. Function: its type.
  template <class Function>
  Function* find(const char* name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  void* handle_;
};

/// The file that holds this code: libfrond.so, or the program that it is linked into.
std::filesystem::path own_file();

}  // namespace frond
