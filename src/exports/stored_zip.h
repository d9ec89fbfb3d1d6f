#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// Files in one, none of them compressed: a ZIP archive as APPNOTE.TXT 6.3 (PKWARE) has it, as numpy.savez writes them.
/// The same files give the same bytes.
class StoredZip {
 public:
  /// Throws InputError for what 32 bits cannot count, which is above 4 GB in all.
  void add(std::string_view name, std::string_view bytes);
  /// The whole archive.
  std::string finish() &&;

 private:
  std::string files_, directory_;
  unsigned count_ = 0;
};

}  // namespace frond
