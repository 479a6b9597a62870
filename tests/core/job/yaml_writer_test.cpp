#include "core/job/yaml_writer.h"

#include <gtest/gtest.h>

#include "core/job/read_values.h"
#include "core/job/yaml_build.h"

namespace hyades::core {
namespace {

/// Equal but for places.
bool same(const YamlNode& a, const YamlNode& b) {
  if (a.kind != b.kind || a.scalar != b.scalar || a.list.size() != b.list.size()) return false;
  if (a.map.size() != b.map.size()) return false;
  for (size_t i = 0; i < a.list.size(); ++i) {
    if (!same(*a.list[i], *b.list[i])) return false;
  }
  for (size_t i = 0; i < a.map.size(); ++i) {
    if (a.map[i].key != b.map[i].key || !same(*a.map[i].value, *b.map[i].value)) return false;
  }
  return true;
}

YamlPtr parsed(const std::string& text) {
  Diagnostics diagnostics;
  YamlPtr root = parse_yaml(text, "test", diagnostics);
  EXPECT_TRUE(diagnostics.empty()) << diagnostics.to_string() << "\n" << text;
  return root;
}

TEST(YamlWriter, IsReadBackAsTheSameTree) {
  const YamlPtr tree = parsed(R"Y(
hyades: 1
name: "a: b # c"
empty: {}
none: []
camera: {look_from: [0, 1e-3, -4.5], fov: 35, look_at: {keys: {1: [0, 0, 0], 24: [1, 0, 0]}}}
materials:
  "odd: name": {type: lambert, color: "#d8c8a8"}
  "12": {type: lambert, color: 0.5}
  "null": {type: "null"}
objects:
  ball: {shape: sphere, at: ["= 3 * cos(t)", 0, '= "x"']}
  line: {mesh: "a b.ply", part: "true", transform: [{scale: 2}, {matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}, {translate: [0.333333343, 1234567.875, -0.000012345]}]}
text: "two lines and \\ \" é"
)Y");
  const std::string text = write_yaml(*tree);
  EXPECT_TRUE(same(*tree, *parsed(text))) << text;
}

TEST(YamlWriter, TextStaysTextAndNumbersStayNumbers) {
  for (const char* odd :
       {"red paint", "../a b.png", "_x",   "a  b", "a - b", "..", "../", "1 2", "null x",
        "true x",    "1",          "-2e5", "true", "null",  "~",  "",    " x",  "x ",
        "#123456",   "= t",        "-",    "a: b", "[x]",   "{",  "&a",  "*a",  "!t",
        "%",         "@",          "'",    "|",    ">",     "?",  "<<",  "nan", ".5"}) {
    YamlMap map;
    map.put("value", yaml_text(odd));
    const YamlPtr back = parsed(write_yaml(*map.node()))->map.front().value;
    EXPECT_EQ(back->kind, YamlNode::Kind::scalar) << odd;
    EXPECT_EQ(back->scalar, odd);
    double number = 0.0;
    EXPECT_TRUE(back->quoted || !parse_number(odd, number)) << odd;
  }
  YamlMap map;
  map.put("number", yaml_number(0.1F))
      .put("word", yaml_word("lambert"))
      .put("flag", yaml_flag(true));
  EXPECT_EQ(write_yaml(*map.node()), "number: 0.1\nword: lambert\nflag: true\n");
}

TEST(YamlWriter, WritesFloatsThatReadBackAsTheSame) {
  for (const float number : {0.1F, 1.0F / 3.0F, 1e-30F, -3.4028235e38F, 16777216.0F, 1e-45F}) {
    double back = 0.0;
    ASSERT_TRUE(parse_number(yaml_number(number)->scalar, back));
    EXPECT_EQ(static_cast<float>(back), number);
  }
}

TEST(YamlWriter, LongListsGoOverSeveralLines) {
  std::vector<float> numbers;
  for (int i = 0; i < 200; ++i) numbers.push_back(static_cast<float>(i) + 0.25F);
  YamlMap map;
  map.put("outer", YamlMap{{"numbers", yaml_numbers(numbers)}, {"next", yaml_word("x")}});
  const std::string text = write_yaml(*map.node());
  EXPECT_TRUE(same(*map.node(), *parsed(text))) << text;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = text.find('\n', begin);
    EXPECT_LE(end - begin, 120U);
    begin = end + 1;
  }
}

}  // namespace
}  // namespace hyades::core
