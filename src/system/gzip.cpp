#include "system/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/parallel.h"

namespace frond {
namespace {

constexpr std::string_view kGzipMagic = "\x1f\x8b";
constexpr size_t kBlock = size_t{1} << 18;

/// Decompressor of zlib, which is ended by the destructor.
class Inflater {
 public:
  Inflater() {
    constexpr int kGzipOnly = 16;
    if (inflateInit2(&stream_, kGzipOnly + MAX_WBITS) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  z_stream& operator*() { return stream_; }

 private:
  z_stream stream_{};
};

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.starts_with(kGzipMagic); }

std::string unpack_gzip(std::string_view bytes, const std::string& name, const Location& where, size_t most) {
  if (most == 0) most = most_unpacked(bytes.size());
  Inflater inflater;
  z_stream& stream = *inflater;
  std::string text;
  std::vector<char> block(kBlock);
  while (true) {
    check_stop();
    if (stream.avail_in == 0 && !bytes.empty()) {
      const size_t piece = std::min<size_t>(bytes.size(), std::numeric_limits<uInt>::max());
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib does not write there
      stream.avail_in = uInt(piece);
      bytes.remove_prefix(piece);
    }
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = uInt(block.size());
    const int verdict = inflate(&stream, Z_NO_FLUSH);
    text.append(block.data(), block.size() - stream.avail_out);
    if (text.size() > most)
      fail(where, "{} unpacks to more than {} bytes; a larger file must be unpacked with gunzip first", name, most);
    if (verdict == Z_STREAM_END) {
      const std::string_view rest(reinterpret_cast<const char*>(stream.next_in), stream.avail_in);
      if (!is_gzip(rest)) return text;  // such as the zeros that pad a tape's block
      if (inflateReset(&stream) != Z_OK) fail(where, "{} cannot be unpacked", name);
    } else if (verdict == Z_BUF_ERROR) {
      fail(where, "{} is compressed and ends too early: it was cut short", name);
    } else if (verdict != Z_OK) {
      fail(where, "{} is compressed and damaged: {}", name, stream.msg ? stream.msg : "zlib cannot read it");
    }
  }
}

std::string unpack_gzip_start(std::string_view bytes) {
  Inflater inflater;
  z_stream& stream = *inflater;
  std::string text(kBlock, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib does not write there
  stream.avail_in = uInt(std::min<size_t>(bytes.size(), std::numeric_limits<uInt>::max()));
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = uInt(text.size());
  const int verdict = inflate(&stream, Z_SYNC_FLUSH);
  if (verdict != Z_OK && verdict != Z_STREAM_END && verdict != Z_BUF_ERROR) return {};
  return text.substr(0, kBlock - std::min<size_t>(stream.avail_out, kBlock));
}

}  // namespace frond
