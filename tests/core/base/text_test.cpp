#include "core/base/text.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace hyades::core {
namespace {

TEST(Text, EditDistance) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("lambret", "lambert"), 1U);  // a swap
  EXPECT_EQ(edit_distance("Max_Depth", "max-depth"), 0U);
}

TEST(Text, ClosestName) {
  const std::vector<std::string> names{
      "lambert", "dielectric", "thin-dielectric", "conductor", "glossy", "mirror", "mix", "null"};
  EXPECT_EQ(closest_name("lambertian", names), "lambert");
  EXPECT_EQ(closest_name("dielctric", names), "dielectric");
  EXPECT_EQ(closest_name("Conductor", names), "conductor");
  EXPECT_EQ(closest_name("mox", names), "mix");
  EXPECT_EQ(closest_name("velvet", names), std::nullopt);
  const std::vector<std::string> keys = {"sampler", "samples"};
  EXPECT_EQ(closest_name("sample", keys), "samples") << "the plural is meant";
  const std::vector<std::string> joined = {"rotate", "rotate_y"};
  EXPECT_EQ(closest_name("rotatey", joined), "rotate_y") << "as it is spoken";
  EXPECT_EQ(closest_name("", names), std::nullopt);
  EXPECT_EQ(closest_name(std::string(100000, 'l'), names), std::nullopt);
  EXPECT_EQ(closest_name("x", {}), std::nullopt);
  const std::vector<std::string> letters{"a", "b"};
  EXPECT_EQ(closest_name("c", letters), std::nullopt);
  EXPECT_EQ(did_you_mean("mirro", names), ", did you mean 'mirror'?");
  EXPECT_EQ(did_you_mean("velvet", names), "");
}

TEST(Text, LettersAreThoseOfAscii) {
  EXPECT_EQ(lower_case("AZaz09[@`{_\xC4"), "azaz09[@`{_\xC4");
  for (const char c : std::string("azAZ09")) EXPECT_TRUE(is_letter_or_digit(c)) << c;
  for (const char c : std::string("[@`{/:-_. \xC4\xE4")) EXPECT_FALSE(is_letter_or_digit(c)) << c;
}

TEST(Text, JoinNames) {
  EXPECT_EQ(join_names({}), "");
  EXPECT_EQ(join_names(std::vector<std::string>{"a"}), "a");
  EXPECT_EQ(join_names(std::vector<std::string>{"a", "b"}), "a or b");
  EXPECT_EQ(join_names(std::vector<std::string>{"a", "b", "c"}), "a, b or c");
}

TEST(Text, Durations) {
  EXPECT_EQ(format_duration(0.0), "0.00 s");
  EXPECT_EQ(format_duration(0.421), "0.42 s");
  EXPECT_EQ(format_duration(9.999), "10.0 s");
  EXPECT_EQ(format_duration(59.96), "1 min 00 s");
  EXPECT_EQ(format_duration(245.0), "4 min 05 s");
  EXPECT_EQ(format_duration(3599.6), "1 h 00 min");
  EXPECT_EQ(format_duration(3720.0), "1 h 02 min");
  EXPECT_EQ(format_duration(86399.0), "1 d 00 h");
  EXPECT_EQ(format_duration(3 * 86400.0 + 4 * 3600.0), "3 d 04 h");
  EXPECT_EQ(format_duration(-1.0), "?");
  EXPECT_EQ(format_duration(std::numeric_limits<double>::infinity()), "?");
  EXPECT_EQ(format_duration(std::numeric_limits<double>::quiet_NaN()), "?");
}

TEST(Text, CountedWordsHaveTheirPlural) {
  EXPECT_EQ(counted(0, "unit"), "0 units");
  EXPECT_EQ(counted(1, "unit"), "1 unit");
  EXPECT_EQ(counted(2, "more worker"), "2 more workers");
}

TEST(Text, SizesAndCounts) {
  EXPECT_EQ(format_bytes(0), "0 B");
  EXPECT_EQ(format_bytes(1023), "1023 B");
  EXPECT_EQ(format_bytes(1536), "1.5 KiB");
  EXPECT_EQ(format_bytes(1024ULL * 1024 - 1), "1.0 MiB");
  EXPECT_EQ(format_bytes(UINT64_MAX), "16.0 EiB");
  EXPECT_EQ(format_count(0), "0");
  EXPECT_EQ(format_count(999), "999");
  EXPECT_EQ(format_count(1000), "1,000");
  EXPECT_EQ(format_count(1234567), "1,234,567");
}

TEST(Text, GuessesOfTimeAreWholeSeconds) {
  EXPECT_EQ(format_time_left(0.0), "0 s");
  EXPECT_EQ(format_time_left(0.2), "1 s");
  EXPECT_EQ(format_time_left(1.67), "2 s");
  EXPECT_EQ(format_time_left(59.4), "59 s");
  EXPECT_EQ(format_time_left(59.6), "1 min 00 s");
  EXPECT_EQ(format_time_left(-1.0), "?");
  EXPECT_EQ(format_time_left(std::numeric_limits<double>::infinity()), "?");
}

TEST(Text, RatesHaveThreeDigits) {
  EXPECT_EQ(format_rate(0.0, "samples"), "0.00 samples/s");
  EXPECT_EQ(format_rate(850.0, "samples"), "850 samples/s");
  EXPECT_EQ(format_rate(999.6, "samples"), "1.00 ksamples/s");
  EXPECT_EQ(format_rate(12'340.0, "samples"), "12.3 ksamples/s");
  EXPECT_EQ(format_rate(2.346e6, "samples"), "2.35 Msamples/s");
  EXPECT_EQ(format_rate(5e12, "samples"), "5000 Gsamples/s");
  EXPECT_EQ(format_rate(4'200.0, "rays"), "4.20 krays/s");
}

TEST(Text, NoiseIsNeverInPowersOfTen) {
  EXPECT_EQ(format_noise(0.0158), "0.016");
  EXPECT_EQ(format_noise(0.999), "1.0");
  EXPECT_EQ(format_noise(1.58), "1.6");
  EXPECT_EQ(format_noise(160.4), "160");
  EXPECT_EQ(format_noise(0.000123), "0.00012");
  EXPECT_EQ(format_noise(2.1e-5), "0.000021");
  EXPECT_EQ(format_noise(9.96e-6), "0.00001");
  EXPECT_EQ(format_noise(1e-9), "< 0.000001");
  EXPECT_EQ(format_noise(0), "0");
}

TEST(Text, WordsOfAShellAreQuotedWhereTheyNeedIt) {
  EXPECT_EQ(shell_word("jobs/a-1.yaml"), "jobs/a-1.yaml");
  EXPECT_EQ(shell_word("x;id;.yaml"), "'x;id;.yaml'");
  EXPECT_EQ(shell_word("my $(job)"), "'my $(job)'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace hyades::core
