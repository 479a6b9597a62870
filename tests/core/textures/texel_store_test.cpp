#include "core/textures/texel_store.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/textures/make_texture.h"
#include "tests/support/random.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

std::vector<std::byte> some_bytes(size_t count) {
  test::Random random(41);
  std::vector<std::byte> bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.bits());
  return bytes;
}

bool same(const Bytes& kept, const std::vector<std::byte>& bytes) {
  return std::equal(kept.span().begin(), kept.span().end(), bytes.begin(), bytes.end());
}

TEST(TexelStore, KeepsInMemoryUpToItsBudgetAndInFilesBeyond) {
  const test::TempFolder folder;
  TexelStore store(300'000, folder.path().string());
  const auto bytes = some_bytes(100'000);
  std::vector<Bytes> kept;
  for (int i = 0; i < 5; ++i) {
    auto one = store.keep(bytes);
    ASSERT_TRUE(one) << one.error().message;
    kept.push_back(*one);
  }
  for (const Bytes& each : kept) EXPECT_TRUE(same(each, bytes));
  EXPECT_EQ(store.in_memory(), 300'000U);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "the files have no names";
  kept.erase(kept.begin());
  EXPECT_EQ(store.in_memory(), 200'000U);
  const auto again = store.keep(bytes);
  EXPECT_TRUE(same(*again, bytes));
  EXPECT_EQ(store.in_memory(), 300'000U) << "the room of what is gone is used again";
}

/// In a sandbox no file can be opened.
TEST(TexelStore, KeepsAllInOneFileThatWasOpenBefore) {
  const test::TempFolder folder;
  const std::string path = folder.file("texels");
  TexelStore store(0, Descriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)),
                   uint64_t{1} << 30U);
  const auto room = [&] {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0 ? static_cast<uint64_t>(info.st_blocks) * 512 : 0;
  };
  const auto bytes = some_bytes(100'000);
  auto others = bytes;
  std::reverse(others.begin(), others.end());
  std::optional<Bytes> first = *store.keep(bytes);
  const Bytes second = *store.keep(others);
  EXPECT_TRUE(same(*first, bytes) && same(second, others)) << "each has its own place";
  EXPECT_GE(room(), 200'000U);
  first.reset();
  EXPECT_LT(room(), 200'000U) << "the room of what is gone is free again";
  EXPECT_TRUE(same(second, others));
  EXPECT_TRUE(same(*store.keep(bytes), bytes));
}

/// A hundred times the same would fill any disk.
TEST(TexelStore, AFileGetsNoLongerThanItMayAndItsRoomIsUsedAgain) {
  const test::TempFolder folder;
  auto file = TexelStore::open_file(folder.path().string());
  TexelStore store(0, std::move(*file), 1'000'000);
  const auto bytes = some_bytes(150'000);
  std::vector<Bytes> kept;
  for (int i = 0; i < 6; ++i) {
    auto one = store.keep(bytes);
    ASSERT_TRUE(one) << one.error().message;
    kept.push_back(*one);
  }
  const auto more = store.keep(bytes);
  ASSERT_FALSE(more);
  EXPECT_NE(more.error().message.find("--texture-disk"), std::string::npos) << more.error().message;
  EXPECT_TRUE(store.keep(some_bytes(70'000))) << "for which there is room";
  for (int i = 0; i < 30; ++i) {
    kept.erase(kept.begin() + i % 6);
    auto another = store.keep(bytes);
    ASSERT_TRUE(another) << "round " << i << ": " << another.error().message;
    kept.push_back(*another);
  }
  for (const Bytes& each : kept) EXPECT_TRUE(same(each, bytes));
}

/// 0 where a file takes half of a disk of 16 MiB and leaves the other half; 77 where none can be
/// mounted.
int fill_small_disk(const std::string& folder) {
  const pid_t child = ::fork();
  if (child == 0) {
    if ((::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) ||
        ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=16m") != 0) {
      ::_exit(77);
    }
    auto file = TexelStore::open_file(folder);
    TexelStore store(0, std::move(*file), UINT64_MAX);
    const auto bytes = some_bytes(100'000);
    std::vector<Bytes> kept;
    for (;;) {
      auto one = store.keep(bytes);
      if (!one) {
        const bool says_why = one.error().message.find("half of what is free") != std::string::npos;
        const bool half = kept.size() > 75 && kept.size() < 84;
        ::_exit(says_why && half ? 0 : 1);
      }
      kept.push_back(*one);
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 100;
}

TEST(TexelStore, AFileTakesNoMoreThanHalfOfWhatIsFree) {
  EXPECT_EQ(TexelStore::half_of_free(Descriptor()), 0U);
  const test::TempFolder folder;
  const int status = fill_small_disk(folder.path().string());
  if (status == 77) GTEST_SKIP() << "mounting is not permitted here";
  EXPECT_EQ(status, 0);
}

TEST(TexelStore, NothingIsKeptInAFileThatIsNone) {
  TexelStore store(0, Descriptor(), UINT64_MAX);
  const auto kept = store.keep(some_bytes(100'000));
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().message.find("could not be made"), std::string::npos);
}

TEST(TexelStore, LittleIsKeptInMemoryInAnyCase) {
  TexelStore store(0, "/nowhere/at/all");
  const auto bytes = some_bytes(1000);
  EXPECT_TRUE(same(*store.keep(bytes), bytes));
}

TEST(TexelStore, SaysWhereThereIsNoRoom) {
  TexelStore store(10, "/nowhere/at/all");
  const auto kept = store.keep(some_bytes(100'000));
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().message.find("/nowhere/at/all"), std::string::npos);
  EXPECT_EQ(store.in_memory(), 0U);
}

TEST(TexelStore, WhatItGaveOutOutlivesIt) {
  const test::TempFolder folder;
  const auto bytes = some_bytes(100'000);
  std::vector<Bytes> kept;
  for (const uint64_t budget : {0, 1'000'000}) {
    TexelStore store(budget, folder.path().string());
    kept.push_back(*store.keep(bytes));
  }
  EXPECT_TRUE(same(kept[0], bytes));
  EXPECT_TRUE(same(kept[1], bytes));
}

// Pictures do not depend on where texels lie.
TEST(TexelStore, ImagesAreReadTheSameFromFiles) {
  const test::TempFolder folder;
  test::Random random(42);
  Image image = make_image(300, 200, {"R", "G", "B"});
  for (float& value : image.data) value = random.uniform();
  TexelStore memory;
  TexelStore file(0, folder.path().string());
  const auto a = make_image_texture(*ImagePyramid::make(image, WrapMode::repeat, memory), {});
  const auto b = make_image_texture(*ImagePyramid::make(image, WrapMode::repeat, file), {});
  EXPECT_GT(memory.in_memory(), size_t{300} * 200 * 12);
  EXPECT_LT(file.in_memory(), size_t{300} * 200 * 2);
  for (int i = 0; i < 1000; ++i) {
    const TexturePoint at{.uv = 3.0F * random.uniform2()};
    EXPECT_EQ(a->color(at), b->color(at));
  }
}

}  // namespace
}  // namespace hyades::core
