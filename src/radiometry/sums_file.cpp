#include "radiometry/sums_file.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/math/random.h"
#include "system/atomic_file.h"
#include "system/file_bytes.h"

static_assert(std::endian::native == std::endian::little, "sums are kept in this order of bytes");

namespace frond {
namespace {

// Format: magic word, number of parts, and for each part the size of its header, header, arrays. Headers and arrays are
// followed by their hashes.
constexpr std::string_view kMagic = "frond sums 3\n";

std::string header_text(const SumsPart& part) {
  auto fields = nlohmann::json::array(), sizes = nlohmann::json::array();
  for (const Identity::Field& f : part.identity.fields()) fields.push_back({f.name, f.value});
  for (const std::string& array : part.arrays) sizes.push_back(array.size());
  return nlohmann::json{{"identity", fields}, {"begin", part.begin}, {"end", part.end}, {"arrays", sizes}}.dump(
      1, ' ', false, nlohmann::json::error_handler_t::replace);
}

class Writer {
 public:
  explicit Writer(NewFile& file) : file_(file) {}
  void add(std::string_view bytes) {
    file_.write({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
  }
  void add(uint64_t number) { add({reinterpret_cast<const char*>(&number), sizeof number}); }
  void add_with_hash(std::string_view bytes) { add(bytes), add(hash_bytes(bytes)); }

 private:
  NewFile& file_;
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::filesystem::path& path) : rest_(bytes), path_(path) {
    if (!rest_.starts_with(kMagic)) fail({}, "\"{}\" is no measurement of frond flux", path.string());
    rest_.remove_prefix(kMagic.size());
  }
  std::string_view take(uint64_t size) {
    if (size > rest_.size()) fail({}, "\"{}\" is cut short: measure it again", path_.string());
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }
  uint64_t take_number() {
    uint64_t number = 0;
    std::memcpy(&number, take(sizeof number).data(), sizeof number);
    return number;
  }
  std::string_view take_with_hash(uint64_t size) {
    const std::string_view taken = take(size);
    if (take_number() != hash_bytes(taken)) fail_as_damaged();
    return taken;
  }
  [[noreturn]] void fail_as_damaged() const { fail({}, "\"{}\" is damaged: measure it again", path_.string()); }

 private:
  std::string_view rest_;
  const std::filesystem::path& path_;
};

}  // namespace

void write_sums(const std::filesystem::path& path, std::span<const SumsPart> parts) {
  NewFile file(path);
  Writer writer(file);
  writer.add(kMagic);
  writer.add(parts.size());
  for (const SumsPart& part : parts) {
    const std::string header = header_text(part);
    writer.add(header.size());
    writer.add_with_hash(header);
    for (const std::string& array : part.arrays) writer.add_with_hash(array);
  }
  file.finish();
}

std::vector<SumsPart> read_sums(const std::filesystem::path& path) {
  const std::string bytes = read_file_bytes(path, {});
  Reader reader(bytes, path);
  std::vector<SumsPart> parts;
  for (uint64_t left = reader.take_number(); left > 0; --left) {
    const std::string_view header = reader.take_with_hash(reader.take_number());
    SumsPart& part = parts.emplace_back();
    std::vector<uint64_t> sizes;
    try {
      const auto parsed = nlohmann::json::parse(header);
      for (const auto& field : parsed.at("identity")) part.identity.add(field.at(0), field.at(1));
      parsed.at("begin").get_to(part.begin), parsed.at("end").get_to(part.end), parsed.at("arrays").get_to(sizes);
    } catch (const nlohmann::json::exception&) {
      reader.fail_as_damaged();
    }
    for (const uint64_t size : sizes) part.arrays.emplace_back(reader.take_with_hash(size));
  }
  return parts;
}

}  // namespace frond
