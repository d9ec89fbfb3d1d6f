#include "shapes/ply_header.h"

#include <algorithm>
#include <charconv>

#include "core/messages/excerpt.h"

namespace frond {
namespace {

/// A word of a header line, with its location.
struct Word {
  std::string_view text;
  Location where;
};

/// Reads the header's lines, split into words.
class HeaderLines {
 public:
  HeaderLines(std::string_view bytes, std::shared_ptr<const std::string> file)
      : bytes_(bytes), file_(std::move(file)) {}

  /// Returns the words of the next line. Throws InputError if the header does not end.
  std::vector<Word> next() {
    if (at_ == bytes_.size()) fail(here(1), "the header does not end: there is no end_header");
    const size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    const std::string_view line = bytes_.substr(at_, end - at_);
    ++line_;
    at_ = std::min(end + 1, bytes_.size());
    return split(line);
  }
  size_t bytes() const { return at_; }
  int lines() const { return line_; }

 private:
  Location here(size_t column) const { return {file_, std::max(line_, 1), static_cast<int>(column)}; }

  /// Splits a line at blanks. A CR at the end is a blank.
  std::vector<Word> split(std::string_view line) const {
    constexpr std::string_view kBlanks = " \t\r";
    std::vector<Word> words;
    for (size_t at = 0; (at = line.find_first_not_of(kBlanks, at)) != line.npos;) {
      const size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
      words.push_back({line.substr(at, end - at), here(at + 1)});
      at = end;
    }
    if (words.empty()) words.push_back({{}, here(1)});
    return words;
  }

  std::string_view bytes_;
  std::shared_ptr<const std::string> file_;
  size_t at_ = 0;
  int line_ = 0;
};

constexpr size_t kLongestMeant = 40;  ///< of a word for which a similar one is searched

/// Throws InputError unless the line has `count` words; `usage` describes them.
void check_words(const std::vector<Word>& line, size_t count, std::string_view usage) {
  if (line.size() == count) return;
  const Word& wrong = line[std::min(count, line.size() - 1)];
  fail(wrong.where, "a header line of {} words is needed: {}", count, usage);
}

/// Both the original names (char, float) and the sized ones (int8, float32) are in use.
PlyType type_of(const Word& word) {
  constexpr std::string_view kNames[] = {"char", "uchar", "short", "ushort", "int",   "uint",   "float",   "double",
                                         "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};
  const auto found = std::find(std::begin(kNames), std::end(kNames), word.text);
  if (found == std::end(kNames))
    fail(word.where, "unknown type \"{}\"{}", excerpt(word.text, word.where),
         suggestion(word.text.substr(0, kLongestMeant), {std::begin(kNames), std::end(kNames)}));
  return static_cast<PlyType>((found - std::begin(kNames)) % 8);
}

/// Encoding of the body. Throws InputError for versions other than 1.0.
PlyFormat format_of(const std::vector<Word>& line) {
  check_words(line, 3, "format, ascii or binary_little_endian or binary_big_endian, 1.0");
  if (line[2].text != "1.0")
    fail(line[2].where, "version {} of the format is not 1.0", excerpt(line[2].text, line[2].where));
  constexpr std::string_view kNames[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  const auto found = std::find(std::begin(kNames), std::end(kNames), line[1].text);
  if (found == std::end(kNames))
    fail(line[1].where, "unknown format \"{}\"{}", excerpt(line[1].text, line[1].where),
         suggestion(line[1].text.substr(0, kLongestMeant), {std::begin(kNames), std::end(kNames)}));
  return static_cast<PlyFormat>(found - std::begin(kNames));
}

/// Element without properties, which follow on lines of their own. Throws InputError for an invalid count.
PlyElement element_of(const std::vector<Word>& line) {
  check_words(line, 3, "element, its name, its count");
  const std::string_view digits = line[2].text;
  uint64_t count = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (error != std::errc() || end != digits.data() + digits.size())
    fail(line[2].where, "\"{}\" is not a count", excerpt(digits, line[2].where));
  return {std::string(line[1].text), count, {}, line[0].where};
}

/// A scalar property, or a list with a type for its length.
PlyProperty property_of(const std::vector<Word>& line) {
  if (line.size() > 1 && line[1].text == "list") {
    check_words(line, 5, "property list, type of the length, type of the values, name");
    const PlyType count_type = type_of(line[2]);
    if (!is_integer(count_type))
      fail(line[2].where, "the length of a list is an integer, not {}", excerpt(line[2].text, line[2].where));
    return {std::string(line[4].text), type_of(line[3]), count_type, line[0].where};
  }
  check_words(line, 3, "property, its type, its name");
  return {std::string(line[2].text), type_of(line[1]), {}, line[0].where};
}

/// Throws InputError for a name that is declared twice.
void add_element(PlyHeader& header, PlyElement element) {
  for (const PlyElement& other : header.elements)
    if (other.name == element.name)
      fail(element.where, "element \"{}\" is declared twice", excerpt(element.name, element.where));
  header.elements.push_back(std::move(element));
}

/// Adds a property to the last element. Throws InputError if there is none or the name is declared twice.
void add_property(PlyHeader& header, PlyProperty property) {
  if (header.elements.empty()) fail(property.where, "a property before any element");
  auto& properties = header.elements.back().properties;
  for (const PlyProperty& other : properties)
    if (other.name == property.name)
      fail(property.where, "property \"{}\" is declared twice", excerpt(property.name, property.where));
  properties.push_back(std::move(property));
}

}  // namespace

PlyHeader read_ply_header(std::string_view bytes, const std::shared_ptr<const std::string>& file) {
  HeaderLines lines(bytes, file);
  if (!bytes.starts_with("ply\n") && !bytes.starts_with("ply\r\n"))
    fail({file, 1, 1}, "this is not a PLY file: it does not begin with a line \"ply\"");
  lines.next();
  PlyHeader header;
  bool has_format = false;
  for (;;) {
    const std::vector<Word> line = lines.next();
    const auto& [keyword, where] = line[0];
    if (keyword == "end_header") {
      if (!has_format) fail(where, "the header has no line \"format\"");
      header.bytes = lines.bytes();
      header.lines = lines.lines();
      return header;
    }
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format")
      header.format = format_of(line), has_format = true;
    else if (keyword == "element")
      add_element(header, element_of(line));
    else if (keyword == "property")
      add_property(header, property_of(line));
    else
      fail(where, "unknown header keyword \"{}\"{}", excerpt(keyword, where),
           suggestion(keyword.substr(0, kLongestMeant),
                      {"format", "element", "property", "comment", "obj_info", "end_header"}));
  }
}

}  // namespace frond
