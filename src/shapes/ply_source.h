#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/messages/excerpt.h"
#include "core/units/number.h"
#include "shapes/ply_header.h"

namespace frond::ply {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Reads the values of a binary body in sequence.
class BinarySource {
 public:
  BinarySource(std::string_view bytes, const PlyHeader& header, std::shared_ptr<const std::string> file)
      : bytes_(bytes),
        at_(header.bytes),
        value_at_(at_),
        swap_((header.format == PlyFormat::little_endian) != (std::endian::native == std::endian::little)),
        file_(std::move(file)) {}

  /// Returns the minimum size of a value, bytes.
  static size_t least_bytes(PlyType type) { return size_of(type); }
  static constexpr size_t kMissingEnd = 0;
  size_t bytes_left() const { return bytes_.size() - at_; }
  /// Whether only blanks are left, which some writers append.
  bool at_end() {
    value_at_ = at_;
    return std::all_of(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), bytes_.end(), is_blank);
  }

  /// Rows of a binary body have no delimiters.
  bool start_row() { return true; }
  bool end_row() { return true; }
  /// Reads a value. Returns false if there is none; `problem` returns the reason.
  bool next(PlyType type, double& value) {
    value_at_ = at_;
    if (size_of(type) > bytes_left()) return false;
    value = value_of(type);
    at_ += size_of(type);
    return true;
  }
  /// Skips values without converting them.
  bool skip(PlyType type, size_t count) {
    value_at_ = at_;
    if (count > bytes_left() / size_of(type)) return false;
    at_ += count * size_of(type);
    return true;
  }
  std::string problem() const { return "the file ends too early"; }
  /// Throws InputError at the last value read.
  [[noreturn]] void fail_here(const std::string& message) const {
    fail({}, "{}: byte {}: {}", *file_, value_at_, message);
  }

 private:
  template <class T>
  /// Returns the value as double, which represents all PLY types exactly; bytes may be unaligned.
  double load() const {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    return static_cast<double>(std::bit_cast<T>(raw));
  }
  double value_of(PlyType type) const {
    switch (type) {
      case PlyType::int8:
        return load<int8_t>();
      case PlyType::uint8:
        return load<uint8_t>();
      case PlyType::int16:
        return load<int16_t>();
      case PlyType::uint16:
        return load<uint16_t>();
      case PlyType::int32:
        return load<int32_t>();
      case PlyType::uint32:
        return load<uint32_t>();
      case PlyType::float32:
        return load<float>();
      case PlyType::float64:
        return load<double>();
    }
    return 0;
  }

  std::string_view bytes_;
  size_t at_, value_at_;  ///< bytes from the start of the file
  bool swap_;
  std::shared_ptr<const std::string> file_;
};

/// Reads the values of an ASCII body. A row of an element is a line.
class AsciiSource {
 public:
  AsciiSource(std::string_view bytes, const PlyHeader& header, std::shared_ptr<const std::string> file)
      : bytes_(bytes), at_(header.bytes), line_start_(at_), line_(header.lines + 1), file_(std::move(file)) {}

  static size_t least_bytes(PlyType) { return 2; }  // a digit and a separator
  static constexpr size_t kMissingEnd = 1;          // the last line may lack its end
  size_t bytes_left() const { return bytes_.size() - at_; }
  bool at_end() {
    skip_empty_lines();
    return !find_word();
  }

  /// Moves to the next line that is not blank.
  bool start_row() {
    skip_empty_lines();
    return find_word() || reject("the file ends too early");
  }
  /// A row must not have further values.
  bool end_row() {
    if (find_word()) return reject("the row has more values than the element has properties");
    if (at_ < bytes_.size()) ++at_, ++line_, line_start_ = at_;
    return true;
  }
  /// Reads a value. Returns false if there is none; `problem` returns the reason.
  bool next(PlyType, double& value) {
    if (!find_word()) return reject(at_ == bytes_.size() ? "the file ends too early" : "the row ends too early");
    const auto number = parse_number(word_);
    if (!number)
      return reject(fmt::format("a number is needed, {} was given", excerpt(word_, std::filesystem::path(*file_))));
    value = *number;
    at_ += word_.size();
    return true;
  }
  bool skip(PlyType type, size_t count) {
    for (double value; count > 0; --count)
      if (!next(type, value)) return false;
    return true;
  }
  const std::string& problem() const { return problem_; }
  [[noreturn]] void fail_here(const std::string& message) const {
    fail({file_, word_line_, static_cast<int>(word_start_ - line_start_) + 1}, "{}", message);
  }

 private:
  /// Records the reason, and returns false.
  bool reject(std::string problem) {
    problem_ = std::move(problem);
    return false;
  }
  void skip_empty_lines() {
    for (; at_ < bytes_.size() && is_blank(bytes_[at_]); ++at_)
      if (bytes_[at_] == '\n') ++line_, line_start_ = at_ + 1;
  }
  /// Finds the next word on this line without consuming it.
  bool find_word() {
    while (at_ < bytes_.size() && bytes_[at_] != '\n' && is_blank(bytes_[at_])) ++at_;
    size_t end = at_;
    while (end < bytes_.size() && !is_blank(bytes_[end])) ++end;
    word_ = bytes_.substr(at_, end - at_);
    word_start_ = at_;
    word_line_ = line_;
    return !word_.empty();
  }

  std::string_view bytes_, word_;
  size_t at_, line_start_, word_start_ = 0;
  int line_, word_line_ = 0;
  std::shared_ptr<const std::string> file_;
  std::string problem_;
};

}  // namespace frond::ply
