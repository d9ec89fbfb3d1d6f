#include "system/tensor_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/messages/excerpt.h"

namespace frond {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they are in the file");

constexpr std::string_view kTensorFileMagic("tensor_file\0", 12);
/// Bytes of a number of each type: none, integers of 8 to 64 bits with and without sign, floats of 16 to 64 bits.
constexpr std::array<uint8_t, 12> kBytes{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

/// Takes numbers and strings from the start of a text.
class Reader {
 public:
  explicit Reader(std::string_view rest) : rest_(rest) {}
  /// False at the end of the text.
  template <class T>
  bool take(T& number) {
    std::string_view bytes;
    if (!take(sizeof(T), bytes)) return false;
    std::memcpy(&number, bytes.data(), sizeof(T));
    return true;
  }
  bool take(size_t count, std::string_view& bytes) {
    if (count > rest_.size()) return false;
    bytes = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return true;
  }

 private:
  std::string_view rest_;
};

}  // namespace

bool is_tensor_file(std::string_view bytes) { return bytes.starts_with(kTensorFileMagic); }

TensorFile::TensorFile(std::string bytes, std::string name, Location where)
    : bytes_(std::move(bytes)), name_(std::move(name)), where_(std::move(where)) {
  if (!is_tensor_file(bytes_)) reject("it is not a tensor file");
  Reader reader(std::string_view(bytes_).substr(kTensorFileMagic.size()));
  std::array<uint8_t, 2> version{};
  uint32_t fields = 0;
  const auto need = [this](bool complete) {
    if (!complete) reject("it is truncated: the list of its fields is incomplete");
  };
  need(reader.take(version) && reader.take(fields));
  if (version[0] != 1 || version[1] != 0)
    reject(fmt::format("version {}.{} of the format; 1.0 is known", version[0], version[1]));
  for (uint32_t i = 0; i < fields; ++i) {
    uint16_t length = 0, dimensions = 0;
    uint64_t offset = 0;
    Field field{};
    need(reader.take(length) && reader.take(length, field.name) && reader.take(dimensions) && reader.take(field.type) &&
         reader.take(offset));
    if (field.type == 0 || field.type >= kBytes.size())
      reject(fmt::format("field \"{}\" has the unknown type {}", excerpt(field.name, std::filesystem::path(name_)),
                         field.type));
    // No product of the shape exceeds the size of the file, so that it cannot overflow.
    const size_t most = offset <= bytes_.size() ? (bytes_.size() - offset) / kBytes[field.type] : 0;
    bool fits = offset <= bytes_.size();
    field.count = 1;
    for (uint16_t d = 0; d < dimensions; ++d) {
      uint64_t size = 0;
      need(reader.take(size));
      fits = fits && (size == 0 || field.count <= most / size);
      field.count = fits ? field.count * size : 0;
      field.shape.push_back(size);
    }
    if (!fits || field.count > most)
      reject(fmt::format("it is truncated: field \"{}\" ends after the {} bytes of the file",
                         excerpt(field.name, std::filesystem::path(name_)), bytes_.size()));
    field.bytes = std::string_view(bytes_).substr(offset, field.count * kBytes[field.type]);
    fields_.push_back(std::move(field));
  }
}

const TensorFile::Field* TensorFile::find(std::string_view name) const {
  const auto found = std::ranges::find(fields_, name, &Field::name);
  return found == fields_.end() ? nullptr : &*found;
}

const TensorFile::Field& TensorFile::floats(std::string_view name, size_t dimensions) const {
  const Field* field = find(name);
  if (!field) reject(fmt::format("it has no field \"{}\"", name));
  if (field->type != kFloat32) reject(fmt::format("field \"{}\" needs 32-bit floats", name));
  if (field->shape.size() != dimensions)
    reject(fmt::format("field \"{}\" has {} dimensions; {} are needed", name, field->shape.size(), dimensions));
  if (field->count == 0) reject(fmt::format("field \"{}\" is empty", name));
  return *field;
}

std::vector<float> TensorFile::numbers(const Field& field, float least) const {
  std::vector<float> values(field.count);
  std::memcpy(values.data(), field.bytes.data(), field.bytes.size());
  for (const float value : values)
    if (!std::isfinite(value) || value < least)
      reject(fmt::format(
          "field \"{}\" contains {}; {}", excerpt(field.name, std::filesystem::path(name_)), value,
          std::isfinite(value) ? fmt::format("numbers from {} are allowed", least) : "finite numbers are needed"));
  return values;
}

std::string tensor_file_of(std::span<const TensorFile::Field> fields) {
  std::string file(kTensorFileMagic), arrays;
  const auto put = [&file](const auto& number) { file.append(reinterpret_cast<const char*>(&number), sizeof number); };
  size_t start = kTensorFileMagic.size() + sizeof(uint16_t) + sizeof(uint32_t);
  for (const TensorFile::Field& f : fields)
    start += 2 * sizeof(uint16_t) + f.name.size() + sizeof f.type + sizeof(uint64_t) * (1 + f.shape.size());
  put(std::array<uint8_t, 2>{1, 0});
  put(uint32_t(fields.size()));
  for (const TensorFile::Field& f : fields) {
    put(uint16_t(f.name.size()));
    file += f.name;
    put(uint16_t(f.shape.size()));
    put(f.type);
    put(uint64_t(start + arrays.size()));
    for (const size_t size : f.shape) put(uint64_t(size));
    arrays += f.bytes;
  }
  return file + arrays;
}

void TensorFile::reject(std::string_view why) const { fail(where_, "\"{}\": {}", name_, why); }

}  // namespace frond
