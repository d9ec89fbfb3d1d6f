#include "system/text_table.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/input_error.h"

namespace frond {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// Names and numbers of a table; a field that is no number is NaN.
struct Content {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
};

Content read(const std::string& text, TableComments comments = TableComments::lines) {
  TextTable table(text, "t.csv", comments);
  Content content;
  for (const TableField& name : table.names()) content.names.emplace_back(name.text);
  const size_t rows = table.rows_left();
  while (table.next()) {
    table.check_fields();
    auto& row = content.rows.emplace_back();
    for (const TableField& f : table.fields()) row.push_back(table.number(f.text).value_or(NAN));
  }
  EXPECT_EQ(content.rows.size(), rows);
  return content;
}

TEST(TextTable, ReadsEveryLayoutOfTheSameTable) {
  for (const std::string text :
       {"x,y,z\n0.1,0.2,0.5\n1,2,3\n", "\xef\xbb\xbfx,y,z\r\n0.1,0.2,0.5\r\n1,2,3\r\n", "x,y,z\r0.1,0.2,0.5\r1,2,3",
        "x;y;z\n0,1;0,2;0,5\n1;2;3\n", "x\ty\tz\n0,1\t0,2\t0,5\n1\t2\t3\n", "x y z\n0.1 0.2 0.5\n  1\t2   3  \n",
        "x y z\n0,1 0,2 0,5\n1 2 3\n", "# a comment\n\nx, y, z\n # another\n0.1, +0.2, 5e-1\n1,2,3\n\n",
        "\"x\",\"y\",\"z\"\n0.1,\"0.2\",0.5\n1,2,3\n", "\"x\" ; \"y\" ; \"z\"\n\"0,1\" ; 0,2 ; 0,5\n1;2;3\n",
        "x,y,z,,\n0.1,0.2,0.5,,\n1,2,3,,\n,,,,\n", "x,y,z\n0.1,0.2,0.5,\n1,2,3,\n"}) {
    const Content content = read(text);
    EXPECT_THAT(std::vector(content.names.begin(), content.names.begin() + 3), ElementsAre("x", "y", "z")) << text;
    ASSERT_EQ(content.rows.size(), 2u) << text;
    EXPECT_EQ(content.rows[0][0], 0.1) << text;
    EXPECT_EQ(content.rows[0][1], 0.2) << text;
    EXPECT_EQ(content.rows[0][2], 0.5) << text;
    EXPECT_EQ(content.rows[1][2], 3) << text;
  }
}

TEST(TextTable, RowNumbersOfRAndPandasHaveNoName) {
  for (const std::string text :
       {",x,y\n0,5,6\n1,7,8\n", "\"\",\"x\",\"y\"\n\"1\",5,6\n\"2\",7,8\n", "Unnamed: 0,x,y\n0,5,6\n1,7,8\n",
        "\tx\ty\n0\t5\t6\n1\t7\t8\n", "\"x\" \"y\"\n\"1\" 5 6\n\"2\" 7 8\n", "x y\n1 5 6\n2 7 8\n",
        "x y\nleaf1 5 6\nleaf2 7 8\n"}) {
    const Content content = read(text);
    EXPECT_THAT(content.names, ElementsAre("", "x", "y")) << text;
    ASSERT_EQ(content.rows.size(), 2u) << text;
    EXPECT_EQ(content.rows[1][1], 7) << text;
  }
  // A Series of pandas.
  EXPECT_THAT(read(",0\n400,0.5\n").names, ElementsAre("", "0"));
}

TEST(TextTable, OneFieldTooManyIsNoRowNumber) {
  EXPECT_EQ(error_of([] { read("x,y\n5,6,7\n"); }), "t.csv:2:1: 3 fields, but the file has 2 columns");
  EXPECT_EQ(error_of([] { read("x,y\n1,6,7\n1,6,7\n"); }), "t.csv:3:1: 3 fields, but the file has 2 columns");
}

TEST(TextTable, NumbersAloneAreNoNames) {
  const Content content = read("# radius x y z\n0,05 0,2 -1 5e-1\n1 2 3 4\n");
  EXPECT_THAT(content.names, IsEmpty());
  ASSERT_EQ(content.rows.size(), 2u);
  EXPECT_THAT(content.rows[0], ElementsAre(0.05, 0.2, -1, 0.5));
  EXPECT_THAT(read("600,1\n700,1\n").rows[1], ElementsAre(700, 1));
}

TEST(TextTable, CommentsBehindNumbersOnRequest) {
  EXPECT_THAT(read("400 1 # lamp\n500 2#\n", TableComments::anywhere).rows[1], ElementsAre(500, 2));
  TextTable words("leaf,R\nno. #3,0.1\n", "t.csv");
  ASSERT_TRUE(words.next());
  EXPECT_EQ(words.fields()[0].text, "no. #3");
}

TEST(TextTable, QuotesHoldSeparatorsAndQuotes) {
  TextTable table("a,b\n\"leaf_solved,specimen=maize\",\"say \"\"x, y\"\"\"\n", "t.csv");
  ASSERT_TRUE(table.next());
  ASSERT_EQ(table.fields().size(), 2u);
  EXPECT_EQ(table.fields()[0].text, "leaf_solved,specimen=maize");
  EXPECT_EQ(table.where(1).text(), "t.csv:2:30: ");
}

TEST(TextTable, WhatIsNoNumberHasAPlace) {
  TextTable table("x;y\n1; 1.234,5\n", "t.csv");
  ASSERT_TRUE(table.next());
  EXPECT_FALSE(table.number(table.fields()[1].text));
  EXPECT_EQ(table.where(1).text(), "t.csv:2:4: ");
  EXPECT_FALSE(table.number("+-1"));
  EXPECT_FALSE(table.number(""));
}

TEST(TextTable, WhatIsNoTableIsRefused) {
  EXPECT_THAT(error_of([] { read("\xff\xfex\0,\0y\0"); }), HasSubstr("UTF-16"));
  EXPECT_THAT(error_of([] { read(std::string("a\0b", 3)); }), StartsWith("t.csv:1:1: not a text file"));
  EXPECT_EQ(error_of([] { read("x,,z\n1,2,3\n"); }),
            "t.csv:2:3: column 2 has values and no name: name it in line 1, or remove it");
  EXPECT_EQ(TextTable("", "t.csv").columns(), 0u);
  EXPECT_EQ(TextTable("\n# nothing\n", "t.csv").columns(), 0u);
}

}  // namespace
}  // namespace frond
