#pragma once

#include <filesystem>
#include <string_view>

#include "core/error.h"

namespace frond {

/// Shared object that is loaded at run time. It is never unloaded, because objects that it creates point into its code.
class SharedObject {
 public:
  /// When symbols are bound: `now`, so that a missing symbol is reported at once and not during a render, or `lazy`, at
  /// the first call of each function, which loads faster.
  enum class Binding { now, lazy };

  /// Throws InputError if the file does not exist or cannot be loaded; `what` describes the file in the message.
  SharedObject(const std::filesystem::path& file, std::string_view what, Binding binding);

  /// Returns an exported function (extern "C") of the type Function, nullptr if no symbol has this name. The type is
  /// not checked.
  template <class Function>
  Function* find(const char* name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  void* handle_;
};

/// Returns the file that contains frond's code: libfrond.so, or the program that it is linked into.
std::filesystem::path own_file();

}  // namespace frond
