#pragma once

#include <map>
#include <memory>
#include <string>

namespace frond {

/// Cache of results that several plug-ins of a scene need. A result lives as long as one of them holds it.
class SharedWork {
 public:
  /// Returns the result for `key`, calling make() if there is none. `key` must state the type T and everything that the
  /// result depends on. Not thread-safe.
  template <class T, class Make>
  std::shared_ptr<const T> get(const std::string& key, const Make& make) {
    std::weak_ptr<const void>& known = known_[key];
    if (const auto result = known.lock()) return std::static_pointer_cast<const T>(result);
    auto result = std::make_shared<const T>(make());
    known = result;
    return result;
  }

 private:
  std::map<std::string, std::weak_ptr<const void>> known_;
};

}  // namespace frond
