// Unfinished files of different owners, which have nothing to do with each other.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "tests/farm/content_testing.h"
#include "tests/support/temp_folder.h"

namespace hyades::farm {
namespace {

namespace fs = std::filesystem;

class ContentOwners : public ::testing::Test {
 protected:
  std::string partials() const { return folder.file("assets/partial"); }
  size_t unfinished() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(partials()), {}));
  }
  /// Begins with the file that is to be `text`, and leaves `bytes` of it behind.
  core::Status leave(const std::string& text, const std::string& bytes, const Uploader& whose) {
    auto writer = store->write(name_of(text), text.size(), whose);
    if (!writer) return writer.error();
    return writer->append(bytes_of(bytes));
  }
  /// All that lies there was last written `seconds` ago, but for what was before.
  void age_all(int64_t seconds) const {
    const timespec then{std::time(nullptr) - seconds, 0};
    const timespec times[2] = {then, then};
    for (const auto& file : fs::directory_iterator(partials())) {
      struct stat now {};
      ASSERT_EQ(::stat(file.path().c_str(), &now), 0);
      if (now.st_mtim.tv_sec < then.tv_sec) continue;
      ASSERT_EQ(::utimensat(AT_FDCWD, file.path().c_str(), times, 0), 0);
    }
  }
  /// An owner who may have so many unfinished files, and so many bytes beside the new one's.
  static Uploader limited(const std::string& owner, uint64_t files, uint64_t bytes = UINT64_MAX) {
    return {owner, [files, bytes](const UnfinishedFiles& others) -> core::Status {
              if (others.files < files && others.bytes <= bytes) return {};
              return core::Error{std::to_string(others.files) + " files of " +
                                 std::to_string(others.bytes) + " bytes"};
            }};
  }

  const test::TempFolder folder;
  const std::unique_ptr<ContentStore> store = open_store(folder.file("assets"));
};

TEST_F(ContentOwners, OnesGarbageSpoilsNoOthersFile) {
  const std::string text(100'000, 'x');
  const std::string name = name_of(text);
  const std::string evil(100'000, 'y');
  ASSERT_TRUE(leave(text, text.substr(0, 60'000), {"ada"}));
  EXPECT_EQ(store->begun(name, "ada"), 60'000U);
  EXPECT_EQ(store->begun(name, "eve"), 0U);
  {
    auto eve = store->write(name, text.size(), {"eve"});
    ASSERT_TRUE(eve) << error_of(eve);
    EXPECT_EQ(eve->offset(), 0U) << "what others have sent is not hers";
    ASSERT_TRUE(eve->append(bytes_of(evil)));
    EXPECT_FALSE(eve->commit());
  }
  ASSERT_TRUE(leave(text, evil.substr(0, 70'000), {"eve"}));
  auto ada = store->write(name, text.size(), {"ada"});
  ASSERT_TRUE(ada) << error_of(ada);
  ASSERT_EQ(ada->offset(), 60'000U);
  ASSERT_TRUE(ada->append(bytes_of(text).subspan(60'000)));
  const core::Status whole = ada->commit();
  ASSERT_TRUE(whole) << error_of(whole);
  EXPECT_TRUE(store->contains(name, text.size()));
  EXPECT_EQ(unfinished(), 0U) << "nobody needs what others have of it";
}

TEST_F(ContentOwners, WhatEachStillHasToSendIsKnown) {
  using Expected = std::map<std::string, uint64_t>;
  {
    auto eve = store->write(name_of("abcdef"), 6, {"eve"});
    auto ada = store->write(name_of("mesh"), 4, {"ada"});
    auto too = store->write(name_of("text"), 4, {"ada"});
    ASSERT_TRUE(eve && ada && too);
    EXPECT_EQ(store->expected_of_owners(), (Expected{{"ada", 8}, {"eve", 6}}));
    ASSERT_TRUE(eve->append(bytes_of("abcd")));
    ASSERT_TRUE(ada->append(bytes_of("mesh")));
    ASSERT_TRUE(ada->commit());
    EXPECT_EQ(store->expected_of_owners(), (Expected{{"ada", 4}, {"eve", 2}}));
    EXPECT_EQ(store->expected(), 6U);
  }
  EXPECT_EQ(store->expected_of_owners(), Expected{});
  EXPECT_EQ(store->expected(), 0U);
  const auto eve = store->write(name_of("abcdef"), 6, {"eve"});
  EXPECT_EQ(store->expected_of_owners(), (Expected{{"eve", 2}})) << "she goes on";
}

TEST_F(ContentOwners, WhoStillWritesAFileThatIsWholeLeavesNothingBehind) {
  const std::string text = "abcdef";
  {
    auto eve = store->write(name_of(text), 6, {"eve"});
    ASSERT_TRUE(eve);
    ASSERT_TRUE(eve->append(bytes_of("ab")));
    put(*store, text);
    EXPECT_EQ(unfinished(), 1U) << "she writes it";
  }
  EXPECT_EQ(unfinished(), 0U);
}

TEST_F(ContentOwners, AnyNameOfAnOwnerIsAPathBelowTheFolder) {
  for (const std::string& owner :
       {std::string("../../x"), std::string("a/b"), std::string("a\0b", 3), std::string(5000, 'n'),
        std::string(".1.0"), std::string("ada "), std::string("Ada")}) {
    ASSERT_TRUE(leave("mesh", "me", {owner})) << owner;
    EXPECT_EQ(store->begun(name_of("mesh"), owner), 2U) << owner;
  }
  EXPECT_EQ(unfinished(), 7U) << "each has his own";
  EXPECT_EQ(store->begun(name_of("mesh")), 0U);
}

TEST_F(ContentOwners, WhatAnOlderCoordinatorHasLeftIsOfWhoHasNoName) {
  const std::string name = name_of("mesh");
  std::ofstream(partials() + "/" + name) << "me";
  EXPECT_EQ(store->begun(name), 2U);
  EXPECT_EQ(store->begun(name, "ada"), 0U);
  auto writer = store->write(name, 4);
  ASSERT_TRUE(writer);
  EXPECT_EQ(writer->offset(), 2U);
}

TEST_F(ContentOwners, WhoHasAsManyAsHeMayIsRefusedAndNobodyElse) {
  const auto text = [](int i) { return "file " + std::to_string(i); };
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(leave(text(i), "f", limited("eve", 5)));
  const core::Status refused = leave(text(5), "f", limited("eve", 5));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "5 files of 5 bytes");
  EXPECT_EQ(unfinished(), 5U) << "not even an empty one is there";
  EXPECT_TRUE(leave(text(0), "i", limited("eve", 5))) << "going on is no new one";
  EXPECT_TRUE(leave(text(5), "f", limited("ada", 5)));
  EXPECT_TRUE(leave(text(5), "f", limited("", 5)));
}

TEST_F(ContentOwners, OnesOwnFilesThatRestGiveWayTheOldestFirst) {
  ASSERT_TRUE(leave("old of ada", "o", {"ada"}));
  ASSERT_TRUE(leave("oldest", "o", {"eve"}));
  age_all(300);
  ASSERT_TRUE(leave("older", "o", {"eve"}));
  age_all(200);
  ASSERT_TRUE(leave("new", "n", {"eve"}));
  ASSERT_TRUE(leave("newer", "n", limited("eve", 3)));
  EXPECT_EQ(store->begun(name_of("oldest"), "eve"), 0U);
  EXPECT_EQ(store->begun(name_of("older"), "eve"), 1U) << "no more than is needed";
  EXPECT_EQ(store->begun(name_of("old of ada"), "ada"), 1U) << "others have nothing to do with it";
  EXPECT_FALSE(leave("newest", "n", limited("eve", 2))) << "two are too new to go";
  EXPECT_EQ(store->begun(name_of("older"), "eve"), 1U) << "nothing goes where that would not do";
}

TEST_F(ContentOwners, AFileThatIsBeingWrittenCountsWithAllItsBytes) {
  const std::string text(1000, 'x');
  auto writer = store->write(name_of(text), text.size(), limited("eve", 10));
  ASSERT_TRUE(writer);
  const core::Status refused = leave("other", "o", limited("eve", 10, 999));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "1 files of 1000 bytes");
  EXPECT_TRUE(leave("other", "o", limited("eve", 10, 1000)));
  ASSERT_TRUE(writer->append(bytes_of(text)));
  ASSERT_TRUE(writer->commit());
  EXPECT_TRUE(leave("third", "t", limited("eve", 10, 1))) << "what is whole does not count";
}

}  // namespace
}  // namespace hyades::farm
