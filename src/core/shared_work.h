#pragma once

#include <map>
#include <memory>
#include <string>

namespace frond {

/// Results that several plugins of a scene need alike: made once, kept as long as somebody holds them.
class SharedWork {
 public:
  /// `key` says all that the result depends on, its kind included; make() returns the T. Not for several threads.
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
