#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/math/affine_map.h"
#include "core/math/vec.h"

namespace frond::mitsuba {

/// Writer of Mitsuba's scene XML: elements, and the properties of a plug-in. Numbers keep all digits of a float.
class Xml {
 public:
  using Attributes = std::initializer_list<std::pair<std::string_view, std::string>>;

  void open(std::string_view tag, const Attributes& attributes);
  void close();
  void element(std::string_view tag, const Attributes& attributes);
  void comment(std::string_view text);

  // Properties of the open element. An empty name is omitted.
  void number(std::string_view name, double value);
  void integer(std::string_view name, long long value);
  void flag(std::string_view name, bool value);
  void text(std::string_view name, const std::string& value);
  void reference(const std::string& id);
  void point(std::string_view name, const Vec3& value);
  void vector(std::string_view name, const Vec3& value);
  /// A transform of four rows; the last is 0 0 0 1.
  void matrix(std::string_view name, const Transform::RowsDouble& rows);

  /// Returns the text; all elements must be closed.
  const std::string& str() const { return text_; }

 private:
  void begin(std::string_view tag, const Attributes& attributes);

  std::string text_ = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";
  std::vector<std::string> tags_;
};

/// Closes an element at the end of a block.
class Element {
 public:
  Element(Xml& xml, std::string_view tag, const Xml::Attributes& attributes) : xml_(xml) { xml.open(tag, attributes); }
  ~Element() { xml_.close(); }
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

 private:
  Xml& xml_;
};

/// Returns numbers with all digits of a float, separated by ", ".
std::string joined(std::span<const double> values);

}  // namespace frond::mitsuba
