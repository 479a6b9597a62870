// The words of scene files, and where they stand.

#include "import/pbrt/tokenizer.h"

#include <gtest/gtest.h>

#include "import/pbrt/read_parameters.h"

namespace hyades::core::pbrt {
namespace {

using Kind = Token::Kind;

TEST(PbrtTokenizer, SaysWhereEachTokenStands) {
  Tokenizer tokens("Shape \"sphere\" # a comment \" [\n  \"float radius\" [1.5]\r\n", "a.pbrt");
  struct Row {
    Kind kind;
    const char* text;
    int line, column;
  };
  for (const Row& row : {Row{Kind::word, "Shape", 1, 1}, Row{Kind::text, "sphere", 1, 7},
                         Row{Kind::text, "float radius", 2, 3}, Row{Kind::open, "[", 2, 18},
                         Row{Kind::word, "1.5", 2, 19}, Row{Kind::close, "]", 2, 22}}) {
    const Token token = tokens.next();
    EXPECT_EQ(token.kind, row.kind);
    EXPECT_EQ(token.text, row.text);
    EXPECT_EQ(token.line, row.line);
    EXPECT_EQ(token.column, row.column);
  }
  EXPECT_EQ(tokens.next().kind, Kind::end);
  EXPECT_EQ(tokens.next().kind, Kind::end);
}

TEST(PbrtTokenizer, UndoesEscapes) {
  Tokenizer tokens(R"("a\"b\\c\n")", "a.pbrt");
  EXPECT_EQ(tokens.next().text, "a\"b\\c\n");
  Tokenizer bad(R"("a\q")", "a.pbrt");
  const Token token = bad.next();
  EXPECT_EQ(token.kind, Kind::broken);
  EXPECT_EQ(bad.place(token).text(), "a.pbrt:1:1");
}

TEST(PbrtTokenizer, QuotesEndOnTheirLine) {
  Tokenizer tokens("\"open\n\"", "a.pbrt");
  EXPECT_EQ(tokens.next().kind, Kind::broken);
  EXPECT_EQ(tokens.next().kind, Kind::end);
}

TEST(PbrtTokenizer, Numbers) {
  EXPECT_EQ(number_of("1e3"), 1000.0);
  EXPECT_EQ(number_of("+.5"), 0.5);
  EXPECT_EQ(number_of("-3."), -3.0);
  EXPECT_EQ(number_of("1e-999"), 0.0);
  for (const char* no : {"", "+", "nan", "inf", "1e999", "0x10", "1.5x", "--1"}) {
    EXPECT_FALSE(number_of(no)) << no;
  }
}

Result<Parameters> parameters(const char* text) {
  Tokenizer tokens(text, "a.pbrt");
  return read_parameters(tokens, srgb_space(), false);
}

TEST(PbrtParameters, ValuesWithAndWithoutBrackets) {
  const auto p = parameters(
      "\"float a\" 2 \"integer b\" [3 -4] \"bool c\" true \"string d\" [\"x\" \"y\"] "
      "\"  point3\tP \" [1 2 3] \"spectrum e\" \"metal-Au-k\" \"spectrum f\" [400 1 500 2] Shape");
  ASSERT_TRUE(p.ok()) << p.error().message;
  Report report;
  const Place place;
  ParameterReader reader(*p, place, report);
  EXPECT_EQ(reader.number("a", 0.0F), 2.0F);
  EXPECT_EQ(reader.integers("b").back(), -4);
  EXPECT_TRUE(reader.flag("c", false));
  EXPECT_EQ(reader.texts("d").size(), 2U);
  EXPECT_EQ(reader.triple("point3", "P", Vec3d(0.0)), Vec3d(1.0, 2.0, 3.0));
  EXPECT_EQ(reader.find("spectrum", "f")->numbers.size(), 4U);
  reader.note_unused();
  ASSERT_EQ(report.notes.size(), 1U);
  EXPECT_NE(report.notes[0].find("spectrum e"), std::string::npos);
}

TEST(PbrtParameters, TheLastOfSeveralCounts) {
  const auto p = parameters("\"float a\" 2 \"float a\" 3");
  Report report;
  const Place place;
  EXPECT_EQ(ParameterReader(*p, place, report).number("a", 0.0F), 3.0F);
}

TEST(PbrtParameters, ErrorsNameThePlace) {
  for (const auto& [text, expected] :
       {std::pair("\"float a\" \"x\"", "a.pbrt:1:11: parameter 'a' has 'x', expected a number"),
        {"\"integer a\" 1.5", "a.pbrt:1:13: parameter 'a' has '1.5', expected a whole number"},
        {"\"float a\" [1", "a.pbrt:1:13: parameter 'a' has the end of the file"},
        {"\"float a\" []", "a.pbrt:1:1: parameter 'a' has no values"},
        {"\"flaot a\" 1", "a.pbrt:1:1: 'flaot' is no type of parameters, did you mean 'float'?"},
        {"\"float\" 1", "expected a type and a name"},
        {"\"bool a\" 1", "expected true or false"},
        {"\"float a\" 1e60", "expected a number"}}) {
    const auto p = parameters(text);
    ASSERT_FALSE(p.ok()) << text;
    EXPECT_NE(p.error().message.find(expected), std::string::npos) << p.error().message;
  }
}

}  // namespace
}  // namespace hyades::core::pbrt
