#include "cli/config_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/number_range.h"

namespace hyades::cli {
namespace {

namespace fs = std::filesystem;

/// An app with an option of each kind, and what it was told.
class ConfigFile : public ::testing::Test {
 protected:
  ConfigFile()
      : file_((fs::path(::testing::TempDir()) /
               (std::string("hyades_") +
                ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".yaml"))
                  .string()) {
    app_.add_option("--threads", threads_)->check(in_range(1, 64));
    app_.add_option("--memory", memory_)->transform(CLI::AsSizeValue(false));
    app_.add_option("--name", name_)->envname("HYADES_CONFIG_FILE_TEST_NAME");
    app_.add_option("--tags", tags_)->delimiter(',')->allow_extra_args(false);
    app_.add_option("--data", data_)->required();
    app_.add_flag("--insecure", insecure_);
    add_config_option(app_);
  }
  ~ConfigFile() override { fs::remove(file_); }

  /// The exit status where the command would end, with what it said in said_.
  std::optional<int> parse(const std::string& yaml, std::vector<std::string> words = {}) {
    std::ofstream(file_) << yaml;
    words.insert(words.begin(), {"hyades", "--config", file_});
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    ::testing::internal::CaptureStderr();
    const auto status = parse_command_line(app_, static_cast<int>(argv.size()), argv.data());
    said_ = ::testing::internal::GetCapturedStderr();
    return status;
  }
  /// That the file is refused at `place` ("2:10") with `words`.
  void expect_refused(const std::string& yaml, const std::string& place, const std::string& words) {
    EXPECT_EQ(parse(yaml), 2) << yaml;
    EXPECT_NE(said_.find(file_ + ":" + place + ": "), std::string::npos) << said_;
    EXPECT_NE(said_.find(words), std::string::npos) << said_;
  }

  CLI::App app_{"", "hyades try"};
  std::string file_;
  int threads_ = 2;
  uint64_t memory_ = 0;
  std::string name_;
  std::vector<std::string> tags_;
  std::string data_;
  bool insecure_ = false;
  std::string said_;
};

TEST_F(ConfigFile, OptionsByTheirNames) {
  ASSERT_EQ(parse("# all of them\nthreads: 8\nmemory: 2G\nname: \"a b\"\ntags: [x, y]\n"
                  "data: /var/lib/hyades\ninsecure: true\n"),
            std::nullopt)
      << said_;
  EXPECT_EQ(threads_, 8);
  EXPECT_EQ(memory_, uint64_t{2} << 30U);
  EXPECT_EQ(name_, "a b");
  EXPECT_EQ(tags_, (std::vector<std::string>{"x", "y"}));
  EXPECT_EQ(data_, "/var/lib/hyades");
  EXPECT_TRUE(insecure_);
}

TEST_F(ConfigFile, TheCommandLineGoesFirstAndTheEnvironmentLast) {
  ::setenv("HYADES_CONFIG_FILE_TEST_NAME", "environment", 1);
  ASSERT_EQ(parse("threads: 8\nname: file\ndata: d\n", {"--threads", "3"}), std::nullopt) << said_;
  ::unsetenv("HYADES_CONFIG_FILE_TEST_NAME");
  EXPECT_EQ(threads_, 3);
  EXPECT_EQ(name_, "file");
}

TEST_F(ConfigFile, FlagsThatAreOffAndListsWithCommas) {
  ASSERT_EQ(parse("data: d\ninsecure: false\ntags: x,y\n"), std::nullopt) << said_;
  EXPECT_FALSE(insecure_);
  EXPECT_EQ(tags_, (std::vector<std::string>{"x", "y"}));
}

TEST_F(ConfigFile, AnEmptyFileSaysNothing) {
  EXPECT_EQ(parse("# nothing yet\n", {"--data", "d"}), std::nullopt) << said_;
}

TEST_F(ConfigFile, WhatIsRequiredIsRequiredHereToo) {
  EXPECT_EQ(parse("threads: 8\n"), 2);
  EXPECT_NE(said_.find("--data is missing"), std::string::npos) << said_;
}

TEST_F(ConfigFile, UnknownNamesAreMistakes) {
  expect_refused("data: d\nthread: 8\n", "2:1", "there is no option 'thread', did you mean");
  expect_refused("data: d\nconfig: other.yaml\n", "2:1", "there is no option 'config'");
  expect_refused("data: d\nhelp: true\n", "2:1", "there is no option 'help'");
}

TEST_F(ConfigFile, ValuesAreCheckedAsOnTheCommandLine) {
  expect_refused("data: d\nthreads: 65\n", "2:10", "--threads 65: expected 1 to 64");
  expect_refused("data: d\nthreads: many\n", "2:10", "--threads many: expected 1 to 64");
  expect_refused("data: d\nthreads: [1, 2]\n", "2:10", "threads: expected a value, but this is");
  expect_refused("data: d\nthreads:\n", "2:1", "threads: expected a value, but this is nothing");
  expect_refused("data: d\ninsecure: yes\n", "2:11", "insecure: expected true or false");
  expect_refused("data: d\ntags: {x: y}\n", "2:7", "tags: expected a value or a list of values");
  expect_refused("data: d\ntags: [[x]]\n", "2:8", "tags: expected a value");
  // Also where the command line has another: a file is right or it is not.
  EXPECT_EQ(parse("data: d\nthreads: [1, 2]\n", {"--threads", "3"}), 2);
}

TEST_F(ConfigFile, WhatIsNoMapOfOptions) {
  expect_refused("- threads\n", "1:1", "expected options by their names");
  expect_refused("threads: 8\nthreads: 9\n", "2:1", "threads");
  EXPECT_EQ(parse("threads: [8\n"), 2);
  EXPECT_NE(said_.find(file_ + ":"), std::string::npos) << said_;
}

TEST_F(ConfigFile, AFileThatIsNotThere) {
  fs::remove(file_);
  std::vector<std::string> words = {"hyades", "--data", "d", "--config", file_};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(parse_command_line(app_, static_cast<int>(argv.size()), argv.data()), 2);
  EXPECT_NE(::testing::internal::GetCapturedStderr().find(file_), std::string::npos);
}

}  // namespace
}  // namespace hyades::cli
