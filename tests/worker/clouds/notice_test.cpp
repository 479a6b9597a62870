#include "worker/clouds/notice.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temp_folder.h"
#include "worker/clouds/cloud.h"

namespace hyades::worker {
namespace {

constexpr std::time_t kNow = 1'700'000'000;  // 2023-11-14T22:13:20Z

TEST(Notice, OfAwsSaysWhen) {
  const auto notice = parse_aws(R"({"action": "stop", "time": "2023-11-14T22:15:20Z"})", kNow);
  ASSERT_TRUE(notice) << notice.error().message;
  EXPECT_EQ(notice->at, "2023-11-14T22:15:20Z");
  EXPECT_EQ(notice->seconds_left, 120);
}

TEST(Notice, WithoutAUsableTimeIsTheShortestThereIs) {
  for (const char* body : {R"({"action": "terminate"})", R"({"action": "terminate", "time": 7})",
                           R"({"action": "terminate", "time": "soon"})"}) {
    const auto notice = parse_aws(body, kNow);
    ASSERT_TRUE(notice) << body;
    EXPECT_EQ(notice->seconds_left, kShortestNotice);
    EXPECT_EQ(notice->at, "2023-11-14T22:13:50Z");
  }
}

TEST(Notice, TimeLeftIsNeitherNegativeNorEndless) {
  EXPECT_EQ(parse_aws(R"({"action": "stop", "time": "2020-01-01T00:00:00Z"})", kNow)->seconds_left,
            0);
  EXPECT_EQ(parse_aws(R"({"action": "stop", "time": "9999-01-01T00:00:00Z"})", kNow)->seconds_left,
            3600);
}

TEST(Notice, WhatIsNoInstanceActionIsAnError) {
  for (const char* body : {"", "null", "[]", "7", "{}", R"({"action": 7})", R"({"action": ""})",
                           "<html>", "{\"action\": \"stop\"", "\xff\xfe"}) {
    EXPECT_FALSE(parse_aws(body, kNow)) << body;
  }
  EXPECT_FALSE(parse_aws(std::string(60'000, '['), kNow));
}

TEST(Notice, OfAzureIsForTheMachineThatItNames) {
  const auto look = [](const std::string& event) {
    return parse_azure(R"({"DocumentIncarnation": 1, "Events": [)" + event + "]}", "node_7", kNow);
  };
  const std::string time = R"("NotBefore": "Tue, 14 Nov 2023 22:14:05 GMT"})";
  const auto ours = look(R"({"EventType": "Preempt", "Resources": ["node_6", "Node_7"], )" + time);
  ASSERT_TRUE(ours && *ours);
  EXPECT_EQ((*ours)->at, "2023-11-14T22:14:05Z");
  EXPECT_EQ((*ours)->seconds_left, 45);
  const auto ended =
      look(R"({"EventType": "Terminate", "Resources": ["node_7"], "NotBefore": ""})");
  ASSERT_TRUE(ended && *ended);
  EXPECT_EQ((*ended)->seconds_left, kShortestNotice);
  for (const std::string& other :
       {std::string(), R"({"EventType": "Preempt", "Resources": ["node_71"], )" + time,
        R"({"EventType": "Reboot", "Resources": ["node_7"], )" + time,
        R"({"EventType": "Freeze", "Resources": ["node_7"], )" + time,
        R"({"EventType": "Preempt", "Resources": "node_7", )" + time,
        R"({"EventType": "Preempt", "Resources": [7, null], )" + time,
        R"({"EventType": ["Preempt"], "Resources": ["node_7"], )" + time}) {
    const auto looked = look(other);
    ASSERT_TRUE(looked) << other;
    EXPECT_FALSE(*looked) << other;
  }
}

TEST(Notice, WhatIsNoListOfEventsIsAnError) {
  for (const char* body : {"", "[]", "{}", R"({"Events": {}})", R"({"Events": [7]})", "TRUE"}) {
    EXPECT_FALSE(parse_azure(body, "node_7", kNow)) << body;
  }
}

TEST(Notice, OfGoogleIsAWord) {
  EXPECT_TRUE(*parse_gcp_preempted("TRUE"));
  EXPECT_TRUE(*parse_gcp_preempted("TRUE\n"));
  EXPECT_FALSE(*parse_gcp_preempted("FALSE"));
  for (const char* body : {"", "true", "TRUE FALSE", "1", "\n", "<html>TRUE"}) {
    EXPECT_FALSE(parse_gcp_preempted(body)) << body;
  }
}

/// A folder that says what Linux says of a machine's firmware.
std::optional<Cloud> cloud_where(const std::vector<std::pair<std::string, std::string>>& files) {
  const test::TempFolder folder;
  for (const auto& [path, text] : files) {
    const auto whole = folder.path() / path;
    std::filesystem::create_directories(whole.parent_path());
    std::ofstream(whole) << text << "\n";
  }
  return find_cloud(folder.path().string());
}

TEST(Cloud, IsTheOneThatTheFirmwareNames) {
  const std::string dmi = "class/dmi/id/";
  EXPECT_EQ(cloud_where({{dmi + "sys_vendor", "Amazon EC2"}}), Cloud::aws);
  EXPECT_EQ(cloud_where({{"hypervisor/uuid", "ec2e1916-9099-7caf-fd21-012345abcdef"}}), Cloud::aws);
  EXPECT_EQ(cloud_where(
                {{dmi + "sys_vendor", "Google"}, {dmi + "product_name", "Google Compute Engine"}}),
            Cloud::gcp);
  EXPECT_EQ(cloud_where({{dmi + "sys_vendor", "Microsoft Corporation"},
                         {dmi + "chassis_asset_tag", "7783-7084-3265-9085-8269-3286-77"}}),
            Cloud::azure);
}

TEST(Cloud, LaptopsAreNone) {
  const std::string dmi = "class/dmi/id/";
  EXPECT_EQ(cloud_where({}), std::nullopt);
  EXPECT_EQ(cloud_where({{dmi + "sys_vendor", "Microsoft Corporation"},
                         {dmi + "product_name", "Surface Laptop"}}),
            std::nullopt);
  EXPECT_EQ(cloud_where({{dmi + "sys_vendor", "Google"}, {dmi + "product_name", "Eve"}}),
            std::nullopt);
}

}  // namespace
}  // namespace hyades::worker
