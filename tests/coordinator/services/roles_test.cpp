// Tokens with roles over real gRPC: every method is refused to those below it, and to no others.
#include <gtest/gtest.h>

#include <google/protobuf/descriptor.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/generic/generic_stub.h>

#include "coordinator/access/token.h"
#include "coordinator/operations/operation.h"
#include "core/base/wall_clock.h"
#include "hyades/v1/admin.grpc.pb.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

class Roles : public ::testing::Test {
 protected:
  void SetUp() override {
    world.start();
    admin = make(v1::ROLE_ADMIN, "root");
    world.token = admin;
  }
  std::string make(v1::Role role, const std::string& name, int64_t lifetime_ms = 0) {
    std::string text;
    StoredToken row;
    const grpc::Status made = world.authority->create(name, role, lifetime_ms, text, row);
    EXPECT_TRUE(made.ok()) << made.error_message();
    id = row.id;
    return text;
  }
  /// What the farm answers to an empty message.
  grpc::Status call(const std::string& method, const std::string& token) {
    grpc::GenericStub stub(world.channel);
    grpc::ClientContext context;
    farm::prepare(context, token, 20s);
    grpc::CompletionQueue queue;
    const grpc::ByteBuffer nothing;
    const auto reader = stub.PrepareUnaryCall(&context, method, nothing, &queue);
    reader->StartCall();
    grpc::ByteBuffer answer;
    grpc::Status status;
    reader->Finish(&answer, &status, &status);
    void* tag = nullptr;
    bool ok = false;
    queue.Next(&tag, &ok);
    return status;
  }
  grpc::Status cancel(uint64_t job, const std::string& token) {
    v1::JobRequest request;
    request.set_job(job);
    v1::JobResponse response;
    grpc::ClientContext context;
    farm::prepare(context, token, 20s);
    return world.jobs->Cancel(&context, request, &response);
  }

  FarmWorld world;
  std::string admin;
  std::string id;  ///< of the last token made
};

TEST_F(Roles, EveryMethodIsRefusedToThoseBelowIt) {
  const std::pair<v1::Role, std::string> tokens[] = {
      {v1::ROLE_VIEWER, make(v1::ROLE_VIEWER, "vera")},
      {v1::ROLE_SUBMITTER, make(v1::ROLE_SUBMITTER, "sam")},
      {v1::ROLE_OPERATOR, make(v1::ROLE_OPERATOR, "olga")},
      {v1::ROLE_WORKER, make(v1::ROLE_WORKER, "node")},
      {v1::ROLE_ADMIN, admin}};
  int refused = 0;
  for (const Operation& operation : all_operations()) {
    if (*operation.method == '\0') continue;
    const std::string method = std::string("/hyades.v1.") + operation.method;
    EXPECT_EQ(call(method, "").error_code(), grpc::StatusCode::UNAUTHENTICATED) << method;
    for (const auto& [role, token] : tokens) {
      const grpc::StatusCode code = call(method, token).error_code();
      EXPECT_NE(code, grpc::StatusCode::UNAUTHENTICATED) << method;
      EXPECT_EQ(code == grpc::StatusCode::PERMISSION_DENIED, !may(role, operation.rule))
          << method << " " << farm::role_name(role) << " " << code;
      refused += code == grpc::StatusCode::PERMISSION_DENIED ? 1 : 0;
    }
  }
  EXPECT_GT(refused, 50);
}

TEST_F(Roles, OwnersSteerTheirJobsAndOperatorsAll) {
  const std::string alice = make(v1::ROLE_SUBMITTER, "alice");
  const std::string bob = make(v1::ROLE_SUBMITTER, "bob");
  world.token = alice;
  const uint64_t job = world.submit(1, [](v1::SubmitRequest& asked) {
    asked.clear_owner();
    asked.set_login("root");
  });
  EXPECT_EQ(world.get(job).job().owner(), "alice") << "the token's name, not the login";
  const grpc::Status refused = cancel(job, bob);
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_NE(refused.error_message().find("belongs to alice"), std::string::npos);
  EXPECT_EQ(cancel(job + 1, bob).error_code(), grpc::StatusCode::NOT_FOUND);
  v1::SubmitRequest as_bob = FarmWorld::request(FarmWorld::document(1));
  as_bob.set_owner("bob");
  v1::SubmitResponse response;
  EXPECT_EQ(world.jobs->Submit(world.context().get(), as_bob, &response).error_code(),
            grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_TRUE(cancel(job, alice).ok());
  world.token = make(v1::ROLE_OPERATOR, "olga");
  const uint64_t for_bob =
      world.submit(1, [](v1::SubmitRequest& asked) { asked.set_owner("bob"); });
  EXPECT_EQ(world.get(for_bob).job().owner(), "bob");
  EXPECT_FALSE(cancel(for_bob, alice).ok());
  EXPECT_TRUE(cancel(for_bob, bob).ok());
}

TEST(OpenFarm, ANameThatNoTokenProvedGivesNobodyRights) {
  FarmWorld world;
  world.start();
  const uint64_t said = world.submit(1, [](v1::SubmitRequest& asked) { asked.set_owner("anna"); });
  const uint64_t login = world.submit(1, [](v1::SubmitRequest& asked) {
    asked.clear_owner();
    asked.set_login("anna");
  });
  EXPECT_EQ(world.get(login).job().owner(), "anna");
  std::string admin;
  std::string anna;
  StoredToken row;
  ASSERT_TRUE(world.authority->create("root", v1::ROLE_ADMIN, 0, admin, row).ok());
  ASSERT_TRUE(world.authority->create("anna", v1::ROLE_SUBMITTER, 0, anna, row).ok());
  const auto cancel = [&](uint64_t job, const std::string& token) {
    world.token = token;
    v1::JobRequest request;
    request.set_job(job);
    v1::JobResponse response;
    return world.jobs->Cancel(world.context().get(), request, &response);
  };
  for (const uint64_t job : {said, login}) {
    const grpc::Status refused = cancel(job, anna);
    EXPECT_EQ(refused.error_code(), grpc::StatusCode::PERMISSION_DENIED);
    EXPECT_NE(refused.error_message().find("without a token that proves it"), std::string::npos);
    EXPECT_FALSE(world.get(job).job().owner_proven());
  }
  world.stop();
  world.start();
  EXPECT_FALSE(cancel(said, anna).ok()) << "after a restart, too";
  EXPECT_TRUE(cancel(said, admin).ok());
  world.token = anna;
  const uint64_t hers = world.submit(1, [](v1::SubmitRequest& asked) { asked.clear_owner(); });
  EXPECT_TRUE(world.get(hers).job().owner_proven());
  world.token = admin;
  const uint64_t given = world.submit(1, [](v1::SubmitRequest& asked) { asked.set_owner("anna"); });
  EXPECT_TRUE(cancel(hers, anna).ok());
  EXPECT_TRUE(cancel(given, anna).ok()) << "an admin vouches for the name";
}

TEST_F(Roles, ATokenIsToldHowLongItHolds) {
  constexpr int64_t kHour = 3'600'000;
  const int64_t before = core::wall_ms();
  world.token = make(v1::ROLE_SUBMITTER, "alice", 8 * kHour);
  v1::WhoAmIResponse me;
  const auto admin_service = v1::Admin::NewStub(world.channel);
  ASSERT_TRUE(admin_service->WhoAmI(world.context().get(), {}, &me).ok());
  EXPECT_GE(me.expires_ms(), before + 8 * kHour);
  EXPECT_EQ(me.expires_ms() - me.warn_ms(), kHour);
  ScriptedWorker::Script script = world.script();
  script.token = make(v1::ROLE_WORKER, "node", 8 * kHour);
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(eventually([&] { return worker.welcome().token_expires_ms() > before; }));
  EXPECT_EQ(worker.welcome().token_expires_ms() - worker.welcome().token_warn_ms(), kHour);
}

TEST_F(Roles, AnOwnerOutlivesTheCoordinator) {
  world.token = make(v1::ROLE_SUBMITTER, "alice");
  const uint64_t job = world.submit(1, [](v1::SubmitRequest& asked) { asked.clear_owner(); });
  const std::string bob = make(v1::ROLE_SUBMITTER, "bob");
  world.stop();
  world.start();
  EXPECT_EQ(cancel(job, bob).error_code(), grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_TRUE(cancel(job, world.token).ok());
}

TEST_F(Roles, ARevokedTokenEndsWhatIsOpenWithIt) {
  const uint64_t job = world.submit(1);
  const std::string worker_token = make(v1::ROLE_WORKER, "node");
  const std::string worker_id = id;
  const std::string viewer = make(v1::ROLE_VIEWER, "vera");
  const std::string viewer_id = id;
  ScriptedWorker::Script script = world.script();
  script.token = worker_token;
  script.hold = true;
  const ScriptedWorker worker(world.address, script);
  const auto workers = [&] {
    v1::InfoResponse info;
    EXPECT_TRUE(world.farm_->Info(world.context().get(), {}, &info).ok());
    return info.workers();
  };
  ASSERT_TRUE(eventually([&] { return workers() == 1; }));
  grpc::ClientContext context;
  farm::prepare(context, viewer, 20s);
  v1::WatchRequest watch;
  watch.set_job(job);
  const auto reader = world.jobs->Watch(&context, watch);
  v1::WatchEvent event;
  ASSERT_TRUE(reader->Read(&event));
  StoredToken row;
  ASSERT_TRUE(world.authority->revoke(viewer_id, row).ok());
  while (reader->Read(&event)) {
  }
  const grpc::Status end = reader->Finish();
  EXPECT_EQ(end.error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_NE(end.error_message().find("revoked"), std::string::npos);
  EXPECT_EQ(workers(), 1U) << "other tokens' streams go on";
  ASSERT_TRUE(world.authority->revoke(worker_id, row).ok());
  EXPECT_TRUE(eventually([&] { return workers() == 0; }));
  EXPECT_TRUE(eventually([&] { return world.get(job).job().leased() == 0; }));
}

TEST_F(Roles, AnAdminMakesAndRevokesOverTheWire) {
  const auto stub = v1::Admin::NewStub(world.channel);
  v1::CreateTokenRequest request;
  request.set_name("sam");
  request.set_role(v1::ROLE_SUBMITTER);
  request.set_lifetime_ms(3'600'000);
  v1::CreateTokenResponse made;
  ASSERT_TRUE(stub->CreateToken(world.context().get(), request, &made).ok());
  EXPECT_EQ(made.token().role(), v1::ROLE_SUBMITTER);
  EXPECT_EQ(made.token().expires_ms() - made.token().created_ms(), 3'600'000);
  world.token = made.secret();
  v1::WhoAmIResponse me;
  ASSERT_TRUE(stub->WhoAmI(world.context().get(), {}, &me).ok());
  EXPECT_EQ(me.name(), "sam");
  EXPECT_TRUE(me.guarded());
  world.token = admin;
  v1::ListTokensResponse all;
  ASSERT_TRUE(stub->ListTokens(world.context().get(), {}, &all).ok());
  EXPECT_EQ(all.tokens_size(), 2);
  EXPECT_EQ(all.SerializeAsString().find(made.secret().substr(16)), std::string::npos);
  v1::RevokeTokenRequest revoke;
  revoke.set_id(made.token().id());
  v1::RevokeTokenResponse gone;
  ASSERT_TRUE(stub->RevokeToken(world.context().get(), revoke, &gone).ok());
  world.token = made.secret();
  EXPECT_EQ(stub->WhoAmI(world.context().get(), {}, &me).error_code(),
            grpc::StatusCode::UNAUTHENTICATED);
  request.set_name("no name");
  world.token = admin;
  EXPECT_EQ(stub->CreateToken(world.context().get(), request, &made).error_code(),
            grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(Roles, WhoDidWhatIsKept) {
  const std::string sam = make(v1::ROLE_SUBMITTER, "sam");
  const std::string vera = make(v1::ROLE_VIEWER, "vera");
  // Two of one millisecond may be told either way round.
  const auto pause = [] { std::this_thread::sleep_for(3ms); };
  const uint64_t job = world.submit(1);
  pause();
  EXPECT_FALSE(cancel(job, vera).ok());
  pause();
  EXPECT_FALSE(cancel(job, sam).ok()) << "another's";
  EXPECT_TRUE(cancel(job, admin).ok());
  pause();
  EXPECT_FALSE(cancel(job, "hyades-unknown-token").ok());
  const auto stub = v1::Admin::NewStub(world.channel);
  const auto context = world.context();
  const auto reader = stub->Audit(context.get(), v1::AuditRequest());
  v1::AuditEntry entry;
  std::vector<std::string> told;
  while (reader->Read(&entry)) {
    told.push_back(entry.deed() + " " + entry.target() + " by " + entry.name() + ": " +
                   entry.result());
    EXPECT_NE(entry.address().find("127.0.0.1"), std::string::npos);
  }
  EXPECT_TRUE(reader->Finish().ok());
  const std::string id_text = std::to_string(job);
  EXPECT_EQ(
      told,
      (std::vector<std::string>{
          "file.upload " + core::to_hex(core::sha256(FarmWorld::document(1))) + " by root: ok",
          "job.submit " + id_text + " by root: ok", "job.cancel  by vera: permission_denied",
          "job.cancel " + id_text + " by sam: permission_denied",
          "job.cancel " + id_text + " by root: ok", "job.cancel  by : unauthenticated"}));
}

TEST_F(Roles, WhoUploadsIsKeptOnceForAFile) {
  world.token = make(v1::ROLE_SUBMITTER, "sam");
  const std::string text(100'000, 'x');
  const std::string name = core::to_hex(core::sha256(text));
  v1::UploadResponse response;
  const auto send = [&](size_t from, size_t to) {
    const auto context = world.context();
    const auto writer = world.assets->Upload(context.get(), &response);
    for (size_t at = from; at < to; at += 10'000) {
      v1::UploadPart part;
      part.set_sha256(farm::to_wire(core::sha256(text)));
      part.set_size(text.size());
      part.mutable_chunk()->set_offset(at);
      part.mutable_chunk()->set_data(text.substr(at, 10'000));
      if (!writer->Write(part)) break;
    }
    writer->WritesDone();
    return writer->Finish();
  };
  EXPECT_EQ(send(0, 50'000).error_code(), grpc::StatusCode::ABORTED) << "left unfinished";
  AuditLog& log = *world.authority->audit();
  const auto told = [&] {
    log.flush();
    std::vector<v1::AuditEntry> all;
    auto reader = log.read();
    while (auto entry = reader.next()) all.push_back(std::move(*entry));
    return all;
  };
  const auto begun = told();
  ASSERT_EQ(begun.size(), 1U) << "before it is whole, and not for each piece";
  EXPECT_EQ(begun[0].deed(), "file.upload");
  EXPECT_EQ(begun[0].name(), "sam");
  EXPECT_EQ(begun[0].target(), name);
  EXPECT_EQ(begun[0].detail(), "100000 bytes");
  EXPECT_TRUE(send(50'000, 100'000).ok());
  EXPECT_TRUE(send(0, 100'000).ok()) << "it is here already";
  const auto all = told();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[1].detail(), "100000 bytes, goes on from 50000");
}

TEST_F(Roles, StrangersWhoMayListenAreToldOf) {
  const auto how = [&](Authority::Options options) {
    const auto known = Authority::open(world.controller->store(), std::move(options));
    return known ? (*known)->unguarded() : known.error().message;
  };
  EXPECT_EQ(how({.beyond = false, .plain = true}), "");
  EXPECT_EQ(how({.beyond = true, .plain = false}), "");
  EXPECT_NE(how({.beyond = true, .plain = true}).find("plain text"), std::string::npos);
  world.controller->farm().set_unguarded("anybody may");
  v1::InfoResponse info;
  ASSERT_TRUE(world.farm_->Info(world.context().get(), {}, &info).ok());
  EXPECT_EQ(info.unguarded(), "anybody may");
}

}  // namespace
}  // namespace hyades::coordinator
