#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace frond {

/// ZIP archive of uncompressed files (PKWARE APPNOTE.TXT 6.3), as numpy.savez writes them. Equal files give equal
/// bytes.
class StoredZip {
 public:
  /// Throws InputError if the total exceeds 4 GB, the limit of 32-bit offsets.
  void add(std::string_view name, std::string_view bytes);
  /// Returns the whole archive.
  std::string finish() &&;

 private:
  std::string files_, directory_;
  unsigned count_ = 0;
};

}  // namespace frond
