// What one owner may have of the farm, and what he is told who has it.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "coordinator/controller/owner_connections.h"
#include "coordinator/controller/owner_quotas.h"
#include "coordinator/controller/unclaimed_files.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kGiB = uint64_t{1} << 30U;

void expect_over_quota(const grpc::Status& status, const std::string& words) {
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
  EXPECT_TRUE(farm::detail_of(status).quota());
  EXPECT_NE(status.error_message().find(words), std::string::npos) << status.error_message();
}

TEST(OwnerQuotas, SayWhichOptionLimitsAndWhatHelps) {
  OwnerLimits limits;
  limits.bytes = 100 * kGiB;
  limits.files = 20;
  limits.jobs = 12;
  limits.core_hours = 50;
  limits.connections = 1;
  const OwnerQuotas quotas(limits);

  EXPECT_TRUE(quotas.may_add_job("ada", 11).ok());
  EXPECT_EQ(quotas.may_add_job("ada", 12).error_message(),
            "ada has 12 open jobs, as many as an owner may have here (--owner-jobs 12): wait for "
            "one to end, or cancel one");
  expect_over_quota(quotas.may_add_job("", 13), "those without a name have 13 open jobs");

  EXPECT_TRUE(quotas.may_upload("ada", 1, {19, 0}, 0).ok());
  expect_over_quota(quotas.may_upload("ada", 1, {20, 0}, 0),
                    "ada has 20 unfinished uploads, as many as an owner may have here "
                    "(--owner-files 20)");
  EXPECT_TRUE(quotas.may_upload("ada", 30 * kGiB, {1, 40 * kGiB}, 30 * kGiB).ok());
  expect_over_quota(quotas.may_upload("ada", 30 * kGiB, {1, 40 * kGiB}, 31 * kGiB),
                    "ada has 71.0 GiB");
  expect_over_quota(quotas.may_upload("ada", 101 * kGiB, {}, 0), "a file of 101.0 GiB");
  expect_over_quota(quotas.may_upload("ada", UINT64_MAX, {1, 1}, 1), "--owner-bytes");

  EXPECT_TRUE(quotas.may_render("ada", uint64_t{49} * 3'600'000'000'000).ok());
  expect_over_quota(quotas.may_render("ada", uint64_t{51} * 3'600'000'000'000),
                    "ada has had 51.0 core-hours within 24 hours, where an owner may have 50 "
                    "(--owner-core-hours)");

  EXPECT_TRUE(quotas.may_connect("ada", 0).ok());
  expect_over_quota(quotas.may_connect("ada", 1), "ada has 1 open stream");
}

TEST(OwnerQuotas, LimitNothingButUnfinishedFilesUnlessTheyAreToldTo) {
  const OwnerQuotas quotas(OwnerLimits{});
  EXPECT_TRUE(quotas.may_add_job("ada", 1'000'000).ok());
  EXPECT_TRUE(quotas.may_render("ada", UINT64_MAX).ok());
  EXPECT_TRUE(quotas.may_connect("ada", 1'000'000).ok());
  EXPECT_TRUE(quotas.may_upload("ada", UINT64_MAX, {999, UINT64_MAX}, 0).ok());
  expect_over_quota(quotas.may_upload("ada", 1, {1000, 1000}, 0), "--owner-files 1000");
}

TEST(OwnerQuotas, LetNobodyHoldMoreThanHalfOfTheMemoryOfOpenJobs) {
  const OwnerQuotas quotas(OwnerLimits{});
  const JobRoom most{1000, uint64_t{64} << 20U};
  EXPECT_TRUE(quotas.may_hold("ada", {500, uint64_t{32} << 20U}, most).ok());
  EXPECT_EQ(quotas.may_hold("ada", {501, 2048}, most).error_message(),
            "with this job ada has 501 frames and 2.0 KiB of what submissions name in open jobs, "
            "where an owner may have half of what there is for all, 500 frames and 32.0 MiB: wait "
            "for one to end, or cancel one");
  expect_over_quota(quotas.may_hold("ada", {1, (uint64_t{32} << 20U) + 1}, most), "half");
}

TEST(OwnerConnections, CountWhatIsOpen) {
  OwnerLimits limits;
  limits.connections = 2;
  const OwnerQuotas quotas(limits);
  OwnerConnections connections(quotas);
  grpc::Status refused;
  const auto first = connections.enter("ada", refused);
  auto second = connections.enter("ada", refused);
  EXPECT_TRUE(first && second && refused.ok());
  EXPECT_FALSE(connections.enter("ada", refused));
  expect_over_quota(refused, "2 open streams");
  EXPECT_TRUE(connections.enter("bob", refused));
  EXPECT_TRUE(refused.ok());
  second.reset();
  EXPECT_TRUE(connections.enter("ada", refused));
  const auto one = connections.enter("", refused);
  const auto two = connections.enter("", refused);
  EXPECT_TRUE(one && two && connections.enter("", refused)) << "who has no name is nobody's";
}

TEST(UnclaimedFiles, CountForTheFirstUntilAJobHasThem) {
  UnclaimedFiles files;
  files.add("ada", "a", 10'000);
  files.add("ada", "b", 1);
  files.add("eve", "a", 10'000);
  EXPECT_EQ(files.bytes_of("ada"), 14'096U) << "a small one is not nothing";
  EXPECT_EQ(files.bytes_of("eve"), 0U);
  files.remove("a");
  files.remove("never");
  EXPECT_EQ(files.bytes_of("ada"), 4096U);
  files.add("eve", "a", 10'000);
  EXPECT_EQ(files.bytes_of("eve"), 10'000U);
  files.remove("a");
  files.remove("b");
  EXPECT_EQ(files.bytes_of("ada") + files.bytes_of("eve"), 0U);
}

/// A farm on which owners may have so much; the client is an admin who submits for others.
class Quotas : public ::testing::Test {
 protected:
  grpc::Status try_to_submit(const std::string& owner, const std::string& key = {},
                             int frames = 1) {
    const std::string text = FarmWorld::document(frames);
    EXPECT_TRUE(world.upload(text).ok());
    v1::SubmitRequest request = FarmWorld::request(text);
    request.set_owner(owner);
    request.set_idempotency_key(key);
    response.Clear();
    return world.jobs->Submit(world.context().get(), request, &response);
  }
  std::string make(v1::Role role, const std::string& name) const {
    std::string text;
    StoredToken row;
    const grpc::Status made = world.authority->create(name, role, 0, text, row);
    EXPECT_TRUE(made.ok()) << made.error_message();
    return text;
  }

  FarmWorld world;
  v1::SubmitResponse response;
};

TEST_F(Quotas, OfRoomOnTheDiskAreNotNeededAgainstWhoAnnouncesAllOfIt) {
  constexpr uint64_t kBudget = uint64_t{64} << 20U;
  world.options.disk.budget = kBudget;
  world.start();
  const auto eve = world.controller->assets().write(core::to_hex(core::sha256("film")), kBudget,
                                                    {"eve"});  // and sends nothing
  ASSERT_TRUE(eve.ok());
  EXPECT_TRUE(world.controller->disk().admit(kBudget / 4, "ada").ok());
  EXPECT_FALSE(world.controller->disk().admit(1, "eve").ok()) << "hers counts for herself";
}

TEST_F(Quotas, OfJobsThatAreNotOver) {
  world.options.per_owner.jobs = 2;
  world.start();
  const std::string key(20, 'k');
  ASSERT_TRUE(try_to_submit("ada", key).ok());
  const uint64_t first = response.job().id();
  ASSERT_TRUE(try_to_submit("ada").ok());
  expect_over_quota(try_to_submit("ada"), "ada has 2 open jobs");
  EXPECT_TRUE(try_to_submit("bob").ok()) << "others may";
  EXPECT_TRUE(try_to_submit("ada", key).ok()) << "it is here already";
  EXPECT_TRUE(response.existed());

  v1::JobResponse now;
  ASSERT_TRUE(world.jobs->Cancel(world.context().get(), about(first), &now).ok());
  ASSERT_TRUE(world.wait_for(first, v1::JOB_STATE_CANCELLED));
  ASSERT_TRUE(try_to_submit("ada").ok());
  expect_over_quota(world.jobs->Retry(world.context().get(), about(first), &now), "--owner-jobs 2");
  world.stop();
  world.start();
  expect_over_quota(try_to_submit("ada"), "ada has 2 open jobs");
}

TEST_F(Quotas, OfFramesOfOpenJobsAreHalfOfAll) {
  world.options.job_room.frames = 10;
  world.start();
  ASSERT_TRUE(try_to_submit("ada", {}, 3).ok());
  const uint64_t first = response.job().id();
  ASSERT_TRUE(try_to_submit("ada", {}, 2).ok());
  const uint64_t second = response.job().id();
  expect_over_quota(try_to_submit("ada"), "ada has 6 frames");
  ASSERT_TRUE(try_to_submit("bob", {}, 4).ok()) << "others get in";
  const grpc::Status full = try_to_submit("eve", {}, 2);
  EXPECT_EQ(full.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << full.error_message();
  EXPECT_FALSE(farm::detail_of(full).quota()) << "it is not her fault, and passes";

  v1::JobResponse now;
  ASSERT_TRUE(world.jobs->Cancel(world.context().get(), about(first), &now).ok());
  ASSERT_TRUE(world.wait_for(first, v1::JOB_STATE_CANCELLED));
  ASSERT_TRUE(try_to_submit("ada").ok());
  expect_over_quota(world.jobs->Retry(world.context().get(), about(first), &now), "ada has 6");
  world.stop();
  world.options.job_room.frames = 2;
  world.start();
  EXPECT_EQ(world.get(second).job().state(), v1::JOB_STATE_RUNNING) << "what was there stays";
  expect_over_quota(try_to_submit("ada"), "half");
}

TEST_F(Quotas, OfWhatOpenJobsNameAreHalfOfAll) {
  world.options.job_room.bytes = 40'000;
  world.start();
  int jobs = 0;
  while (jobs < 100 && try_to_submit("ada").ok()) ++jobs;
  EXPECT_EQ(jobs, 3) << "each takes 6 KiB at least";
  expect_over_quota(try_to_submit("ada"), "half");
  EXPECT_TRUE(try_to_submit("bob").ok()) << "others get in";
}

TEST_F(Quotas, OfJobsAreToldBeforeFilesAreUploaded) {
  world.options.per_owner.jobs = 1;
  world.start();
  ASSERT_TRUE(try_to_submit("ada").ok());
  expect_over_quota(
      world.jobs->Submit(world.context().get(), FarmWorld::request("not here"), &response),
      "--owner-jobs 1");
}

TEST_F(Quotas, OfCoreHoursHoldThoughTheJobIsDeleted) {
  world.options.unit_time = 1ms;
  world.options.per_owner.core_hours = 1e-9;
  world.start();
  ASSERT_TRUE(try_to_submit("ada").ok());
  const uint64_t job = response.job().id();
  {
    const ScriptedWorker worker(world.address, world.script());
    ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  }
  EXPECT_GT(world.get(job).job().core_seconds(), 0);
  expect_over_quota(try_to_submit("ada"), "--owner-core-hours");
  EXPECT_TRUE(try_to_submit("bob").ok());
  v1::DeleteJobResponse gone;
  ASSERT_TRUE(eventually(
      [&] { return world.jobs->Delete(world.context().get(), about(job), &gone).ok(); }));
  expect_over_quota(try_to_submit("ada"), "--owner-core-hours");
  world.stop();
  world.start();
  expect_over_quota(try_to_submit("ada"), "--owner-core-hours");
}

TEST_F(Quotas, OfBytesAreOfWhatNoJobHas) {
  world.options.per_owner.bytes = 100'000;
  world.start();
  const std::string document = FarmWorld::document(1) + "#" + std::string(60'000, 'x');
  ASSERT_TRUE(world.upload(document).ok());
  const std::string other(60'000, 'y');
  expect_over_quota(world.upload(other), "--owner-bytes");
  EXPECT_TRUE(world.upload(document).ok()) << "what is here takes no more";
  (void)world.submit_text(document);
  EXPECT_TRUE(world.upload(other).ok()) << "the first has a job";
  expect_over_quota(world.upload(std::string(100'001, 'z')), "a file of");
}

TEST_F(Quotas, OfBytesCountAnUploadThatIsOpen) {
  world.options.per_owner.bytes = 100'000;
  world.start();
  const std::string large(90'000, 'x');
  v1::UploadResponse nothing;
  const auto context = world.context();
  const auto writer = world.assets->Upload(context.get(), &nothing);
  v1::UploadPart part;
  part.set_sha256(farm::to_wire(core::sha256(large)));
  part.set_size(large.size());
  part.mutable_chunk()->set_data("x");
  ASSERT_TRUE(writer->Write(part));
  const std::string name = core::to_hex(core::sha256(large));
  ASSERT_TRUE(eventually([&] { return world.controller->assets().begun(name) == 1; }));
  expect_over_quota(world.upload(std::string(20'000, 'y')), "--owner-bytes");
  writer->WritesDone();
  EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::ABORTED);
}

TEST_F(Quotas, OfConnectionsAreOfTokensOfOneName) {
  world.options.per_owner.connections = 1;
  world.start();
  world.token = make(v1::ROLE_ADMIN, "root");
  ASSERT_TRUE(try_to_submit("ada").ok());
  v1::WatchRequest request;
  request.set_job(response.job().id());
  const std::string tokens[] = {make(v1::ROLE_VIEWER, "ada"), make(v1::ROLE_SUBMITTER, "ada")};
  world.token = tokens[0];
  v1::WatchEvent event;
  const auto first_context = world.context();
  const auto first = world.jobs->Watch(first_context.get(), request);
  ASSERT_TRUE(first->Read(&event));
  const auto watch = [&] {
    const auto context = world.context();
    const auto reader = world.jobs->Watch(context.get(), request);
    if (!reader->Read(&event)) return reader->Finish();
    context->TryCancel();
    (void)reader->Finish();
    return grpc::Status::OK;
  };
  expect_over_quota(watch(), "ada has 1 open stream");
  world.token = tokens[1];
  expect_over_quota(watch(), "--owner-connections 1");
  expect_over_quota(world.upload("a file"), "--owner-connections 1");
  EXPECT_EQ(world.get(request.job()).job().owner(), "ada") << "what is no stream is answered";
  world.token = make(v1::ROLE_VIEWER, "bob");
  EXPECT_TRUE(watch().ok());
  world.token = tokens[1];
  first_context->TryCancel();
  (void)first->Finish();
  EXPECT_TRUE(eventually([&] { return watch().ok(); }));
}

}  // namespace
}  // namespace hyades::coordinator
