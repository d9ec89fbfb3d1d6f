#include "exports/stored_zip.h"

#include <zlib.h>

#include <cstdint>
#include <limits>

#include "core/error.h"

namespace frond {
namespace {

constexpr size_t kMost = std::numeric_limits<uint32_t>::max();

/// Appends an integer of up to 8 bytes, little-endian.
void put(std::string& out, uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += char(value >> (8 * i) & 0xff);
}

/// Returns the fields that a local header and a directory entry have in common.
std::string entry(std::string_view name, std::string_view bytes) {
  constexpr uint64_t kVersion = 20, kFirstOfJanuary1980 = 0x21;
  std::string e;
  put(e, kVersion, 2);
  put(e, 0, 2);  // no flags
  put(e, 0, 2);  // stored
  put(e, 0, 2);  // time: midnight
  put(e, kFirstOfJanuary1980, 2);
  put(e, crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()), 4);
  put(e, bytes.size(), 4);  // compressed size
  put(e, bytes.size(), 4);
  put(e, name.size(), 2);
  put(e, 0, 2);  // no extra field
  return e;
}

}  // namespace

void StoredZip::add(std::string_view name, std::string_view bytes) {
  if (files_.size() + name.size() + bytes.size() > kMost) fail({}, "the archive would be larger than 4 GB");
  const std::string e = entry(name, bytes);
  directory_ += "PK\x01\x02";
  put(directory_, 20, 2);
  directory_ += e;
  directory_.append(2 + 2 + 2 + 4, '\0');  // no comment, one disk, no attributes
  put(directory_, files_.size(), 4);
  directory_ += name;
  files_ += "PK\x03\x04";
  files_.append(e).append(name).append(bytes);
  ++count_;
}

std::string StoredZip::finish() && {
  std::string end = "PK\x05\x06";
  put(end, 0, 4);
  put(end, count_, 2), put(end, count_, 2);
  put(end, directory_.size(), 4), put(end, files_.size(), 4);
  put(end, 0, 2);
  return std::move(files_) + directory_ + end;
}

}  // namespace frond
