// Requests that take much memory to be parsed.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

#include "coordinator/operations/executors.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

// gRPC and HTTP once let in one large request each.
TEST(LargeRequests, BothDoorsTogetherLookAtOneAtATime) {
  WebWorld world;
  world.start();
  v1::FindMissingRequest request;
  farm::Json files = farm::Json::array();
  const std::string text = "a file";
  for (int i = 0; i < 2000; ++i) {
    v1::JobFile& file = *request.add_files();
    file.set_sha256(farm::to_wire(core::sha256(text)));
    file.set_size(text.size());
    files.push_back({{"sha256", core::to_hex(core::sha256(text))}, {"size", text.size()}});
  }
  ASSERT_GT(request.ByteSizeLong(), farm::kMaxRequestBytes);
  const std::string body = farm::Json({{"files", files}}).dump();
  const auto by_grpc = [&] {
    v1::FindMissingResponse response;
    return world.farm.assets->FindMissing(world.farm.context().get(), request, &response)
        .error_code();
  };
  const auto by_http = [&] { return world.client->post("/api/v1/assets/missing", body).status; };

  EXPECT_EQ(by_http(), 200);
  EXPECT_EQ(by_grpc(), grpc::StatusCode::OK);
  std::optional<LargeRequest> somebody_elses(std::in_place);
  ASSERT_TRUE(eventually([&] { return somebody_elses->admit(farm::kMaxRequestBytes + 1).ok(); }))
      << "the last one has been answered";
  EXPECT_EQ(by_http(), 503);
  EXPECT_EQ(by_grpc(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  somebody_elses.reset();
  EXPECT_EQ(by_http(), 200);
  EXPECT_EQ(by_grpc(), grpc::StatusCode::OK);
}

}  // namespace
}  // namespace hyades::coordinator
