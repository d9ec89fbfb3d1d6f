#include "exports/mitsuba/xml.h"

#include <fmt/format.h>

#include "exports/xml_text.h"

namespace frond::mitsuba {
namespace {

/// Nine digits distinguish all floats.
std::string digits(double value) { return fmt::format("{:.9g}", value); }

}  // namespace

/// Attributes without a value are omitted, so that names and ids may be empty.
void Xml::begin(std::string_view tag, const Attributes& attributes) {
  text_.append(2 * tags_.size(), ' ');
  text_ += '<';
  text_ += tag;
  for (const auto& [name, value] : attributes)
    if (!value.empty() || name == "value") text_ += fmt::format(" {}=\"{}\"", name, xml_escaped(value));
}

void Xml::open(std::string_view tag, const Attributes& attributes) {
  begin(tag, attributes);
  text_ += ">\n";
  tags_.emplace_back(tag);
}

/// Elements are closed in the reverse order of opening.
void Xml::close() {
  const std::string tag = std::move(tags_.back());
  tags_.pop_back();
  text_.append(2 * tags_.size(), ' ');
  text_ += fmt::format("</{}>\n", tag);
}

void Xml::element(std::string_view tag, const Attributes& attributes) {
  begin(tag, attributes);
  text_ += "/>\n";
}

void Xml::comment(std::string_view text) { text_ += std::string(2 * tags_.size(), ' ') + xml_comment(text); }

void Xml::number(std::string_view name, double value) {
  element("float", {{"name", std::string(name)}, {"value", digits(value)}});
}
void Xml::integer(std::string_view name, long long value) {
  element("integer", {{"name", std::string(name)}, {"value", std::to_string(value)}});
}
void Xml::flag(std::string_view name, bool value) {
  element("boolean", {{"name", std::string(name)}, {"value", value ? "true" : "false"}});
}
void Xml::text(std::string_view name, const std::string& value) {
  element("string", {{"name", std::string(name)}, {"value", value}});
}
void Xml::reference(const std::string& id) { element("ref", {{"id", id}}); }
/// Mitsuba parses points and vectors as three numbers.
void Xml::point(std::string_view name, const Vec3& value) {
  element("point", {{"name", std::string(name)},
                    {"value", joined(std::vector{double(value.x), double(value.y), double(value.z)})}});
}
void Xml::vector(std::string_view name, const Vec3& value) {
  element("vector", {{"name", std::string(name)},
                     {"value", joined(std::vector{double(value.x), double(value.y), double(value.z)})}});
}

void Xml::matrix(std::string_view name, const Transform::RowsDouble& rows) {
  std::string values;
  for (const auto& row : rows)
    for (const double v : row) values += digits(v) + ' ';
  const Element transform(*this, "transform", {{"name", std::string(name)}});
  element("matrix", {{"value", values + "0 0 0 1"}});
}

std::string joined(std::span<const double> values) {
  std::string text;
  for (const double v : values) text += (text.empty() ? "" : ", ") + digits(v);
  return text;
}

}  // namespace frond::mitsuba
