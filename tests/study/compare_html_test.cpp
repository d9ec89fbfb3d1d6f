#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <stdexcept>

#include "study/compare/report/html.h"

namespace frond::compare {
namespace {

std::string base64_of(std::string_view text) {
  return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

/// The examples of RFC 4648, section 10.
TEST(Html, Base64) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
}

std::string half(float value) { return half_floats(std::array{value}); }
std::string bytes(std::array<unsigned char, 2> little_endian) { return base64(little_endian); }

TEST(Html, HalfFloats) {
  EXPECT_EQ(half(0), bytes({0x00, 0x00}));
  EXPECT_EQ(half(1), bytes({0x00, 0x3c}));
  EXPECT_EQ(half(-2), bytes({0x00, 0xc0}));
  EXPECT_EQ(half(65504), bytes({0xff, 0x7b}));
  EXPECT_EQ(half(1e9f), bytes({0xff, 0x7b}));              // held
  EXPECT_EQ(half(0x1p-24f), bytes({0x01, 0x00}));          // the smallest there is
  EXPECT_EQ(half(1 + 0x1p-11f), bytes({0x00, 0x3c}));      // half way: to even
  EXPECT_EQ(half(1 + 3 * 0x1p-11f), bytes({0x02, 0x3c}));  // half way: to even
  EXPECT_EQ(half(2 - 0x1p-12f), bytes({0x00, 0x40}));      // up into the next exponent
  EXPECT_EQ(half(std::numeric_limits<float>::quiet_NaN()), bytes({0x00, 0x00}));
}

TEST(Html, TextIsMadeSafe) { EXPECT_EQ(html_text("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;"); }

TEST(Html, ATableHasANameAndANote) {
  Table table{"A > B"};
  table.add("candidate", "a<b");
  EXPECT_EQ(to_html(table, "x & y"),
            "<h3>A &gt; B</h3>\n<div class=\"scroll\"><table><thead><tr><th scope=\"col\">candidate</th></tr></thead>"
            "<tbody>\n<tr><td>a&lt;b</td></tr>\n</tbody></table></div>\n<p class=\"note\">x &amp; y</p>\n");
}

TEST(Html, PagesAreFilled) {
  EXPECT_EQ(filled("<{{a}}|{{b}}>", {{"a", "1"}, {"b", "{{a}}"}}), "<1|{{a}}>");
  EXPECT_THROW(filled("{{c}}", {}), std::logic_error);
}

}  // namespace
}  // namespace frond::compare
