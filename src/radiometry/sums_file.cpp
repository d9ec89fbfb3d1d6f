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

// Format: magic word, size of the header, header, arrays. Each section is followed by its hash.
constexpr std::string_view kMagic = "frond sums 1\n";

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string header_text(const Identity& identity) {
  auto fields = nlohmann::json::array();
  for (const Identity::Field& f : identity.fields()) fields.push_back({f.name, f.value});
  return nlohmann::json{{"identity", fields}}.dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
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

void write_sums(const std::filesystem::path& path, const Identity& identity,
                const std::vector<std::span<const std::byte>>& arrays) {
  const std::string header = header_text(identity);
  NewFile file(path);
  Writer writer(file);
  writer.add(kMagic);
  writer.add(header.size());
  writer.add_with_hash(header);
  for (const auto& array : arrays) writer.add_with_hash(text_of(array));
  file.finish();
}

void read_sums(const std::filesystem::path& path, const Identity& identity,
               const std::vector<std::span<std::byte>>& arrays) {
  const std::string bytes = read_file_bytes(path, {});
  Reader reader(bytes, path);
  const std::string_view header = reader.take_with_hash(reader.take_number());
  Identity found;
  try {
    const auto parsed = nlohmann::json::parse(header);
    for (const auto& field : parsed.at("identity")) found.add(field.at(0), field.at(1));
  } catch (const nlohmann::json::exception&) {
    reader.fail_as_damaged();
  }
  const std::string difference = identity.difference(found, "this command", "\"" + path.string() + "\"");
  if (!difference.empty()) fail({}, "--resume: this is another measurement. {}", difference);
  std::vector<std::string_view> pieces;
  for (const auto& array : arrays) pieces.push_back(reader.take_with_hash(array.size()));
  for (size_t i = 0; i < arrays.size(); ++i) std::memcpy(arrays[i].data(), pieces[i].data(), arrays[i].size());
}

}  // namespace frond
