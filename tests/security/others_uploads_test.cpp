// Who would spoil the uploads of others, by the hashes of their files or by taking all the room.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string>

#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

/// A farm with two submitters, one of whom knows what the other uploads.
class OthersUploads : public ::testing::Test {
 protected:
  void SetUp() override {
    world.start();
    (void)make(v1::ROLE_ADMIN, "root");
    ada = make(v1::ROLE_SUBMITTER, "ada");
    eve = make(v1::ROLE_SUBMITTER, "eve");
  }
  std::string make(v1::Role role, const std::string& name) const {
    std::string text;
    StoredToken row;
    const grpc::Status made = world.farm.authority->create(name, role, 0, text, row);
    EXPECT_TRUE(made.ok()) << made.error_message();
    return text;
  }
  /// Sends `bytes`, from `offset` on, of the file of `size` bytes that has this digest, and ends.
  grpc::Status send(const std::string& token, const Digest& digest, uint64_t size, uint64_t offset,
                    const std::string& bytes) {
    world.farm.token = token;
    v1::UploadResponse response;
    const auto context = world.farm.context();
    const auto writer = world.farm.assets->Upload(context.get(), &response);
    v1::UploadPart part;
    part.set_sha256(farm::to_wire(digest));
    part.set_size(size);
    part.mutable_chunk()->set_offset(offset);
    part.mutable_chunk()->set_data(bytes);
    writer->Write(part);
    writer->WritesDone();
    return writer->Finish();
  }
  HttpClient::Response put(const std::string& token, const Digest& digest, uint64_t size,
                           uint64_t offset, const std::string& bytes) const {
    return world.client->send("PUT",
                              "/api/v1/assets/" + core::to_hex(digest) + "?size=" +
                                  std::to_string(size) + "&offset=" + std::to_string(offset),
                              bytes, {{"Authorization", "Bearer " + token}});
  }
  /// Where the coordinator says that this one's upload goes on.
  uint64_t goes_on(const std::string& token, const Digest& digest, uint64_t size) {
    world.farm.token = token;
    v1::FindMissingRequest request;
    request.add_files()->set_sha256(farm::to_wire(digest));
    request.mutable_files(0)->set_size(size);
    v1::FindMissingResponse response;
    const grpc::Status found =
        world.farm.assets->FindMissing(world.farm.context().get(), request, &response);
    EXPECT_TRUE(found.ok()) << found.error_message();
    EXPECT_EQ(response.missing_size(), 1);
    return response.missing_size() == 1 ? response.missing(0).offset() : 0;
  }

  /// How often a file was begun or opened again, with all that is there of it read.
  int opened(const Digest& digest) {
    world.farm.authority->audit()->flush();
    AuditLog::Reader reader = world.farm.authority->audit()->read();
    int times = 0;
    while (const auto entry = reader.next()) times += entry->target() == core::to_hex(digest);
    return times;
  }

  WebWorld world;
  std::string ada;
  std::string eve;
  const std::string file = std::string(50'000, 'a') + std::string(50'000, 'b');
  const std::string garbage = std::string(100'000, 'e');
  const Digest digest = core::sha256(file);
};

TEST_F(OthersUploads, GarbageUnderTheirHashCostsItsSenderAlone) {
  EXPECT_EQ(send(ada, digest, file.size(), 0, file.substr(0, 50'000)).error_code(),
            grpc::StatusCode::ABORTED);
  EXPECT_EQ(goes_on(eve, digest, file.size()), 0U) << "nor is she told what others have sent";
  EXPECT_EQ(send(eve, digest, file.size(), 0, garbage).error_code(), grpc::StatusCode::DATA_LOSS);
  EXPECT_EQ(send(eve, digest, file.size(), 0, garbage.substr(0, 70'000)).error_code(),
            grpc::StatusCode::ABORTED);
  EXPECT_EQ(send(eve, digest, 1, 0, "e").error_code(), grpc::StatusCode::DATA_LOSS);
  ASSERT_EQ(goes_on(ada, digest, file.size()), 50'000U);
  const grpc::Status whole = send(ada, digest, file.size(), 50'000, file.substr(50'000));
  EXPECT_TRUE(whole.ok()) << whole.error_message();
  EXPECT_TRUE(send(eve, digest, file.size(), 0, garbage).ok()) << "it is here, and not by her";
  const auto stored = world.farm.controller->assets().read(core::to_hex(digest));
  ASSERT_TRUE(stored);
  EXPECT_EQ(std::string(stored->chars(), stored->size()), file);
}

TEST_F(OthersUploads, TheSameOverHttp) {
  EXPECT_EQ(put(ada, digest, file.size(), 0, file.substr(0, 50'000)).status, 200);
  const auto lost = put(eve, digest, file.size(), 0, garbage);
  EXPECT_EQ(lost.status, 422) << lost.body;
  EXPECT_EQ(put(eve, digest, file.size(), 0, garbage.substr(0, 70'000)).status, 200);
  const auto whole = put(ada, digest, file.size(), 50'000, file.substr(50'000));
  EXPECT_EQ(whole.status, 200) << whole.body;
  EXPECT_TRUE(farm::Json::parse(whole.body)["complete"].get<bool>()) << whole.body;
}

TEST_F(OthersUploads, NobodyHasAFileReadAgainForEachByteOfIt) {
  ASSERT_EQ(put(eve, digest, file.size(), 0, file.substr(0, 50'000)).status, 200);
  for (uint64_t i = 0; i < 4; ++i) {
    const auto other = put(eve, digest, file.size() + 1, 50'000 + i, "b");
    EXPECT_EQ(other.status, 400) << other.body;
    EXPECT_NE(other.body.find("size: expected 100000"), std::string::npos) << other.body;
    EXPECT_EQ(put(eve, digest, file.size(), 50'000 + i, "b").status, 200);
  }
  EXPECT_EQ(opened(digest), 1);
}

TEST_F(OthersUploads, ManyOfOnesThatAreOpenCloseNobodyElses) {
  for (int i = 0; i < 64; ++i) {
    ASSERT_EQ(put(eve, core::sha256("file " + std::to_string(i)), 2, 0, "f").status, 200);
  }
  for (uint64_t i = 0; i < 4; ++i) {
    EXPECT_EQ(put(ada, digest, file.size(), i, "a").status, 200);
  }
  EXPECT_EQ(opened(digest), 1);
}

TEST_F(OthersUploads, ThousandsThatAreNeverEndedAreRefused) {
  const auto begin = [&](const std::string& token, int i) {
    return send(token, core::sha256("file " + std::to_string(i)), 2, 0, "f");
  };
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(begin(eve, i).error_code(), grpc::StatusCode::ABORTED) << i;
  }
  const grpc::Status refused = begin(eve, 1000);
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NE(refused.error_message().find("eve has 1000 unfinished uploads"), std::string::npos)
      << refused.error_message();
  EXPECT_EQ(put(eve, core::sha256("more"), 2, 0, "f").status, 429) << "by whichever door";
  const std::filesystem::directory_iterator left(world.farm.options.folder + "/assets/partial");
  EXPECT_EQ(std::distance(left, {}), 1000);
  EXPECT_TRUE(send(ada, digest, file.size(), 0, file).ok()) << "others have room";
}

}  // namespace
}  // namespace hyades::coordinator
