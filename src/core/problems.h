#pragma once

#include <set>
#include <utility>

#include "core/error.h"

namespace frond {

/// Several errors at once, each with its place. `what()` has the first of them, a line each.
class InputErrors : public InputError {
 public:
  /// `messages` are those that were kept of `count`.
  InputErrors(std::vector<std::string> messages, size_t count);
  const std::vector<std::string>& messages() const { return messages_; }
  size_t count() const { return count_; }
  /// The first of them, and how many there are beside, a line each behind `prefix`.
  std::string text(std::string_view prefix, size_t most) const;

 private:
  std::vector<std::string> messages_;
  size_t count_;
};

/// An error that may only follow from another one: a name that is unknown because what makes it could not be read.
class Consequence : public InputError {
 public:
  using InputError::InputError;
};

/// Errors that are collected, so that all of a scene's are reported in one run.
class Problems {
 public:
  /// Each message once.
  void add(const InputError& error);
  /// Goes on after an InputError, which it keeps. Says whether there was none.
  template <class Act>
  bool attempt(Act&& act) {
    try {
      std::forward<Act>(act)();
      return true;
    } catch (const InputError& error) {
      add(error);
      return false;
    }
  }
  bool empty() const { return count_ == 0; }
  const std::vector<std::string>& messages() const { return messages_; }
  size_t count() const { return count_; }
  /// Throws what was collected: InputErrors, or the one error as it was.
  void check() const;

 private:
  static constexpr size_t kMostKept = 1000;
  std::vector<std::string> messages_;
  std::set<std::string, std::less<>> known_;
  size_t count_ = 0;
};

}  // namespace frond
