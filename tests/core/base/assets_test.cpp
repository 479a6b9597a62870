#include "core/base/assets.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/atomic_file.h"
#include "core/base/hash.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

void put(const std::string& path, std::string_view text) {
  fs::create_directories(fs::path(path).parent_path());
  ASSERT_TRUE(write_file(path, std::as_bytes(std::span(text))));
}

std::string_view view(const Bytes& bytes) { return {bytes.chars(), bytes.size()}; }

std::string error_of(const Result<Bytes>& result) {
  return result.ok() ? "no error" : result.error().message;
}

TEST(Assets, ReferencesAreRelativeToTheAssetThatNamesThem) {
  EXPECT_EQ(resolve_reference("a.png"), "a.png");
  EXPECT_EQ(resolve_reference("a.mtl", "meshes/a.obj"), "meshes/a.mtl");
  EXPECT_EQ(resolve_reference("../t/./a.png", "meshes/a.mtl"), "t/a.png");
  EXPECT_EQ(resolve_reference("/x/a.png", "meshes/a.mtl"), "/x/a.png");
  EXPECT_EQ(resolve_reference("a.mtl", "/data/a.obj"), "/data/a.mtl");
}

TEST(Assets, OpensFiles) {
  const TempFolder folder;
  put(folder.file("meshes/a.obj"), "obj");
  put(folder.file("meshes/a.mtl"), "mtl");
  put(folder.file("empty"), "");
  const auto resolver = make_file_resolver(folder.path().string());
  Result<Bytes> obj = resolver->open("meshes/a.obj");
  ASSERT_TRUE(obj) << error_of(obj);
  EXPECT_EQ(view(*obj), "obj");
  const Result<Bytes> mtl = resolver->open("a.mtl", "meshes/a.obj");
  ASSERT_TRUE(mtl) << error_of(mtl);
  EXPECT_EQ(view(*mtl), "mtl");
  const Result<Bytes> empty = resolver->open("empty");
  ASSERT_TRUE(empty) << error_of(empty);
  EXPECT_EQ(empty->size(), 0U);
  // The bytes outlive the file's name and its replacement.
  put(folder.file("meshes/a.obj"), "other");
  EXPECT_EQ(view(*obj), "obj");
  // A file the user named from elsewhere is the user's business.
  const auto deeper = make_file_resolver(folder.file("meshes"));
  EXPECT_TRUE(deeper->open("../empty"));
  EXPECT_TRUE(deeper->open(folder.file("empty")));
}

TEST(Assets, RefusesWhatIsNoFile) {
  const TempFolder folder;
  const auto resolver = make_file_resolver(folder.path().string());
  EXPECT_NE(error_of(resolver->open("gone.png")).find("gone.png: no such file"), std::string::npos);
  EXPECT_NE(error_of(resolver->open("")).find("empty"), std::string::npos);
  EXPECT_NE(error_of(resolver->open(".")).find("a folder"), std::string::npos);
  ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_NE(error_of(resolver->open("pipe")).find("a pipe"), std::string::npos);  // returns at once
  EXPECT_NE(error_of(resolver->open("/dev/zero")).find("a device"), std::string::npos);
  EXPECT_NE(error_of(resolver->open(std::string("a\0b", 3))).find("zero byte"), std::string::npos);
  EXPECT_FALSE(resolver->open(std::string(5000, 'x')));

  const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, folder.file("socket").c_str(), sizeof(address.sun_path) - 1);
  ASSERT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  EXPECT_NE(error_of(resolver->open("socket")).find("socket"), std::string::npos);
  ::close(fd);
}

TEST(Assets, RecordsEachAssetOnce) {
  const TempFolder folder;
  put(folder.file("m/a.obj"), "abc");
  put(folder.file("b.png"), "");
  const auto files = make_file_resolver(folder.path().string());
  RecordingResolver resolver(*files);
  EXPECT_TRUE(resolver.open("m/a.obj"));
  EXPECT_TRUE(resolver.open("../b.png", "m/a.obj"));
  EXPECT_TRUE(resolver.open("./m/a.obj"));
  EXPECT_FALSE(resolver.open("gone"));
  const auto records = resolver.records();
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[0].reference, "m/a.obj");
  EXPECT_EQ(records[0].sha256, to_hex(sha256(std::string_view("abc"))));
  EXPECT_EQ(records[0].size, 3U);
  EXPECT_EQ(records[1].reference, "b.png");
}

}  // namespace
}  // namespace hyades::core
