// Tokens: what is kept of them, and when they open the farm.
#include "coordinator/access/authority.h"

#include <gtest/gtest.h>

#include <netinet/in.h>
#include <sys/socket.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <mutex>
#include <thread>

#include "coordinator/access/peer_user.h"
#include "coordinator/access/token.h"
#include "core/base/descriptor.h"
#include "core/base/wall_clock.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

class Tokens : public ::testing::Test {
 protected:
  void SetUp() override { open(); }
  void open(const std::string& shared = {}) {
    close();
    auto opened = open_sqlite_job_store(folder.file("state.db"));
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    store = std::move(*opened);
    auto known = Authority::open(*store, {.shared_token = shared});
    ASSERT_TRUE(known.ok()) << known.error().message;
    authority = std::move(*known);
  }
  void close() {
    authority.reset();
    store.reset();
  }
  /// Its text; its id is in `id`.
  std::string make(v1::Role role, const std::string& name, int64_t lifetime_ms = 0) {
    std::string text;
    StoredToken row;
    const grpc::Status made = authority->create(name, role, lifetime_ms, text, row);
    EXPECT_TRUE(made.ok()) << made.error_message();
    id = row.id;
    return text;
  }
  grpc::Status show(const std::string& text) {
    caller = {};
    return authority->admit(text.empty() ? text : "Bearer " + text, caller);
  }

  test::TempFolder folder;
  std::unique_ptr<JobStore> store;
  std::unique_ptr<Authority> authority;
  std::string id;
  Caller caller;
};

TEST_F(Tokens, WithoutAnyTheFarmIsOpen) {
  EXPECT_FALSE(authority->guarded());
  EXPECT_TRUE(show("").ok());
  EXPECT_EQ(caller.role, v1::ROLE_ADMIN);
  EXPECT_TRUE(show("a-token-of-another-farm").ok());
}

TEST_F(Tokens, OfThemOnlyAHashIsKept) {
  const std::string text = make(v1::ROLE_ADMIN, "ada");
  EXPECT_EQ(text.size(), 80U);
  const std::string secret = text.substr(16);
  close();
  for (const char* part : {"state.db", "state.db-wal"}) {
    std::ifstream file(folder.file(part), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(bytes.find(secret.substr(0, 20)), std::string::npos) << part;
  }
  open();
  ASSERT_EQ(authority->tokens().size(), 1U);
  EXPECT_EQ(authority->tokens()[0].hash, token_hash(text));
}

TEST_F(Tokens, TellWhoCalls) {
  const std::string ada = make(v1::ROLE_ADMIN, "ada");
  const std::string bob = make(v1::ROLE_SUBMITTER, "bob");
  EXPECT_TRUE(show(bob).ok());
  EXPECT_EQ(caller.name, "bob");
  EXPECT_EQ(caller.role, v1::ROLE_SUBMITTER);
  EXPECT_EQ(caller.token_id, id);
  std::string forged = bob;
  forged.back() = forged.back() == '0' ? '1' : '0';
  for (const std::string& wrong :
       {std::string(), forged, bob.substr(1), bob + " ", ada.substr(0, 16) + bob.substr(16),
        std::string("hyades-00000000-") + std::string(64, '0')}) {
    EXPECT_EQ(show(wrong).error_code(), grpc::StatusCode::UNAUTHENTICATED) << wrong;
  }
  EXPECT_EQ(authority->admit("Basic " + bob, caller).error_code(),
            grpc::StatusCode::UNAUTHENTICATED);
}

TEST_F(Tokens, ThoseInUseAreToldOfBeforeTheyExpire) {
  close();
  store = open_sqlite_job_store(folder.file("state.db")).value();
  const int64_t now = core::wall_ms();
  constexpr int64_t kDay = int64_t{24} * 3600 * 1000;
  const auto add = [&](const std::string& made_id, int64_t expires, int64_t used, int64_t revoked) {
    const StoredToken row{
        made_id, "n" + made_id, v1::ROLE_WORKER, std::string(32, 'h'), now - 300 * kDay,
        expires, used,          revoked};
    EXPECT_TRUE(store->add_token(row).ok());
  };
  add("00000001", now + 3 * kDay, now - kDay, 0);
  add("00000002", now + 3 * kDay, 0, 0);                    // never used
  add("00000003", now + 3 * kDay, now - 40 * kDay, 0);      // not for long
  add("00000004", now + 3 * kDay, now - kDay, now - kDay);  // revoked
  add("00000005", now + 30 * kDay, now - kDay, 0);          // there is time
  add("00000006", 0, now - kDay, 0);                        // never expires
  std::mutex mutex;
  std::vector<std::string> told;
  authority = Authority::open(*store, {.tell_expiring = [&](const std::string& line) {
                const std::lock_guard lock(mutex);
                told.push_back(line);
              }}).value();
  for (int i = 0; i < 400; ++i) {
    std::this_thread::sleep_for(10ms);
    const std::lock_guard lock(mutex);
    if (!told.empty()) break;
  }
  // It looks again, and says nothing more today.
  make(v1::ROLE_ADMIN, "ada");
  std::this_thread::sleep_for(50ms);
  authority.reset();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].find("token 00000001 of n00000001 (worker) expires on"), std::string::npos)
      << told[0];
}

TEST_F(Tokens, RevokedOrExpiredTheyOpenNothingMore) {
  make(v1::ROLE_ADMIN, "ada");
  const std::string short_lived = make(v1::ROLE_VIEWER, "eve", 150);
  EXPECT_TRUE(show(short_lived).ok());
  const std::string text = make(v1::ROLE_VIEWER, "bob");
  StoredToken row;
  ASSERT_TRUE(authority->revoke(id, row).ok());
  EXPECT_NE(show(text).error_message().find("revoked"), std::string::npos);
  std::this_thread::sleep_for(200ms);
  EXPECT_NE(show(short_lived).error_message().find("expired"), std::string::npos);
  open();
  EXPECT_EQ(show(text).error_code(), grpc::StatusCode::UNAUTHENTICATED) << "after a restart, too";
  EXPECT_EQ(show(short_lived).error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(authority->revoke("00000000", row).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(Tokens, WhoStaysIsSentAwayAtOnce) {
  make(v1::ROLE_ADMIN, "ada");
  Caller eve;
  Caller bob;
  ASSERT_TRUE(authority->admit("Bearer " + make(v1::ROLE_VIEWER, "eve", 200), eve).ok());
  ASSERT_TRUE(authority->admit("Bearer " + make(v1::ROLE_VIEWER, "bob"), bob).ok());
  std::atomic<int> eves{0};
  std::atomic<int> bobs{0};
  const auto first = authority->visit(eve, [&](const grpc::Status&) { ++eves; });
  const auto second = authority->visit(bob, [&](const grpc::Status&) { ++bobs; });
  auto third = authority->visit(bob, [&](const grpc::Status&) { ++bobs; });
  third.reset();
  for (int i = 0; i < 2000 && eves == 0; ++i) std::this_thread::sleep_for(5ms);
  EXPECT_EQ(eves, 1) << "nobody asks for anything while it expires";
  EXPECT_EQ(bobs, 0);
  StoredToken row;
  ASSERT_TRUE(authority->revoke(id, row).ok());
  EXPECT_EQ(bobs, 1);
  const auto late = authority->visit(bob, [&](const grpc::Status& why) {
    EXPECT_EQ(why.error_code(), grpc::StatusCode::UNAUTHENTICATED);
    ++bobs;
  });
  EXPECT_EQ(bobs, 2) << "who comes between is told at once";
}

TEST_F(Tokens, TheFirstIsAnAdminsAndShutsOthersOut) {
  Caller nobody;
  ASSERT_TRUE(authority->admit("", nobody).ok());
  bool gone = false;
  const auto visit = authority->visit(nobody, [&](const grpc::Status&) { gone = true; });
  std::string text;
  StoredToken row;
  EXPECT_EQ(authority->create("bob", v1::ROLE_SUBMITTER, 0, text, row).error_code(),
            grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_FALSE(gone);
  make(v1::ROLE_ADMIN, "ada");
  EXPECT_TRUE(gone);
  EXPECT_EQ(show("").error_code(), grpc::StatusCode::UNAUTHENTICATED);
  ASSERT_TRUE(authority->revoke(id, row).ok());
  EXPECT_TRUE(authority->guarded()) << "to revoke the last one opens nothing";
}

TEST_F(Tokens, OneForAllIsAnAdmins) {
  open("one-token-for-all-of-us");
  EXPECT_TRUE(authority->guarded());
  EXPECT_TRUE(show("one-token-for-all-of-us").ok());
  EXPECT_EQ(caller.role, v1::ROLE_ADMIN);
  EXPECT_EQ(caller.token_id, kSharedToken);
  EXPECT_FALSE(show("one-token-for-all-of-u").ok());
  const std::string bob = make(v1::ROLE_SUBMITTER, "bob");
  EXPECT_TRUE(show(bob).ok());
  EXPECT_EQ(caller.name, "bob");
}

TEST_F(Tokens, AMachineThatHasJoinedHasOneOfItsOwn) {
  make(v1::ROLE_ADMIN, "ada");
  const std::string joins = make(v1::ROLE_WORKER, "nodes");
  const std::string other = make(v1::ROLE_WORKER, "others");
  ASSERT_TRUE(show(joins).ok());
  EXPECT_EQ(caller.worker, "");
  WorkerCredential joined;
  ASSERT_TRUE(authority->admit_worker(caller, "worker-a", true, joined).ok());
  const std::string own = joined.machine_token;
  ASSERT_TRUE(own.ends_with("-worker-a")) << own;
  ASSERT_TRUE(show(own).ok());
  EXPECT_EQ(caller.role, v1::ROLE_WORKER);
  EXPECT_EQ(caller.name, "nodes");
  EXPECT_EQ(caller.worker, "worker-a");
  WorkerCredential again;
  ASSERT_TRUE(authority->admit_worker(caller, "worker-a", true, again).ok());
  EXPECT_EQ(again.machine_token, "") << "it has one";
  EXPECT_EQ(again.name, joined.name);
  EXPECT_EQ(authority->admit_worker(caller, "worker-b", true, again).error_code(),
            grpc::StatusCode::PERMISSION_DENIED);
  // Nobody makes another of it.
  for (size_t i = 0; i < own.size(); ++i) {
    std::string changed = own;
    changed[i] = changed[i] == '1' ? '2' : '1';
    EXPECT_FALSE(show(changed).ok()) << i;
  }
  EXPECT_FALSE(show(own + "b").ok());
  EXPECT_FALSE(show(other.substr(0, 16) + own.substr(16)).ok()) << "of another token";
}

TEST_F(Tokens, AMachinesEndsWithTheOneThatItHasJoinedWith) {
  make(v1::ROLE_ADMIN, "ada");
  const std::string joins = make(v1::ROLE_WORKER, "nodes");
  ASSERT_TRUE(show(joins).ok());
  WorkerCredential joined;
  ASSERT_TRUE(authority->admit_worker(caller, "worker-a", true, joined).ok());
  ASSERT_TRUE(show(joined.machine_token).ok());
  StoredToken row;
  ASSERT_TRUE(authority->revoke(id, row).ok());
  EXPECT_NE(show(joined.machine_token).error_message().find("was revoked"), std::string::npos);
}

TEST_F(Tokens, WorkersCountByWhatTheyShow) {
  make(v1::ROLE_ADMIN, "ada");
  const auto name_of = [&](const std::string& token, const std::string& worker, bool keeps) {
    EXPECT_TRUE(show(token).ok());
    WorkerCredential known;
    EXPECT_TRUE(authority->admit_worker(caller, worker, keeps, known).ok());
    return known.name;
  };
  const std::string joins = make(v1::ROLE_WORKER, "nodes");
  EXPECT_EQ(name_of(joins, "worker-a", false), name_of(joins, "worker-b", false));
  EXPECT_NE(name_of(joins, "worker-a", true), name_of(joins, "worker-b", true));
  EXPECT_NE(name_of(joins, "worker-a", false), "");
  EXPECT_EQ(name_of(joins, "no name", true), name_of(joins, "none\neither", true));
  std::string cloud;
  std::string more;
  StoredToken row;
  const auto of_pool = [](const std::string& name, v1::Role role, const std::string& pool) {
    v1::CreateTokenRequest asked;
    asked.set_name(name);
    asked.set_role(role);
    asked.set_pool(pool);
    return asked;
  };
  ASSERT_TRUE(authority->create(of_pool("cloud", v1::ROLE_WORKER, "aws"), cloud, row).ok());
  ASSERT_TRUE(authority->create(of_pool("more", v1::ROLE_WORKER, "aws"), more, row).ok());
  EXPECT_FALSE(authority->create(of_pool("a", v1::ROLE_ADMIN, "pool"), more, row).ok());
  EXPECT_FALSE(authority->create(of_pool("a", v1::ROLE_WORKER, "a pool"), more, row).ok());
  EXPECT_EQ(name_of(cloud, "worker-a", true), name_of(more, "worker-b", true));
  EXPECT_NE(name_of(cloud, "worker-a", true), name_of(joins, "worker-a", true));
  open();
  EXPECT_EQ(name_of(cloud, "worker-a", true), name_of(more, "worker-b", true)) << "it is kept";
  EXPECT_EQ(name_of(make(v1::ROLE_ADMIN, "eve"), "worker-a", true), "") << "may do everything";
}

TEST_F(Tokens, TellHowManyMachinesMayJoinAndWhoseTheyAre) {
  make(v1::ROLE_ADMIN, "ada");
  const auto joined = [&](const std::string& token) {
    EXPECT_TRUE(show(token).ok());
    WorkerCredential known;
    EXPECT_TRUE(authority->admit_worker(caller, "worker-a", true, known).ok());
    return known;
  };
  v1::CreateTokenRequest asked;
  asked.set_name("nodes");
  asked.set_role(v1::ROLE_WORKER);
  asked.set_machines(3);
  std::string text;
  StoredToken row;
  ASSERT_TRUE(authority->create(asked, text, row).ok());
  open();
  const WorkerCredential first = joined(text);
  EXPECT_EQ(first.machines, 3U) << "it is kept";
  EXPECT_EQ(first.joined_with, row.id);
  EXPECT_EQ(first.owner, "nodes");
  const WorkerCredential again = joined(first.machine_token);
  EXPECT_EQ(again.joined_with, row.id) << "by its own token too";
  EXPECT_EQ(again.machines, 3U);
  EXPECT_EQ(joined(make(v1::ROLE_WORKER, "nodes")).machines, 1000U);
  const WorkerCredential admins = joined(make(v1::ROLE_ADMIN, "eve"));
  EXPECT_EQ(admins.joined_with, "") << "an admin may do everything";
  EXPECT_EQ(admins.owner, "eve");
}

TEST_F(Tokens, ThatAreNoneAreBoundedOnThisMachineTooWhereAProxyMayBe) {
  const std::string right = make(v1::ROLE_ADMIN, "ada");
  const auto from_proxy = [&](const std::string& text) {
    caller = {};
    caller.address = "127.0.0.1:5000";
    return authority->admit("Bearer " + text, caller).error_code();
  };
  for (int i = 0; i < 20; ++i) EXPECT_EQ(from_proxy("x"), grpc::StatusCode::UNAUTHENTICATED) << i;
  EXPECT_EQ(from_proxy("x"), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(from_proxy(right), grpc::StatusCode::OK) << "whoever else comes by the proxy";
}

/// A connection between two sockets of this process.
struct Joined {
  Joined() {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    auto* place = reinterpret_cast<sockaddr*>(&at);
    EXPECT_EQ(::bind(listener.get(), place, size), 0);
    EXPECT_EQ(::listen(listener.get(), 1), 0);
    EXPECT_EQ(::getsockname(listener.get(), place, &size), 0);
    EXPECT_EQ(::connect(theirs.get(), place, size), 0);
    ours = core::Descriptor(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC));
  }
  core::Descriptor listener{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  core::Descriptor theirs{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  core::Descriptor ours;
};

TEST_F(Tokens, WithoutAnyTheOwnerIsKnownByTheOneConnectionThatHeCallsBy) {
  authority = Authority::open(*store, {.owner_only = true}).value();
  const Joined his;
  const Joined other;
  caller.address = own_end(his.theirs.get());
  const auto admitted = [&](const OwnEnd& own) { return authority->admit("", caller, own).ok(); };
  const auto ours = [&] { return own_end(his.ours.get()); };
  EXPECT_TRUE(admitted(ours));
  EXPECT_FALSE(admitted({})) << "by none";
  EXPECT_FALSE(admitted([&] { return own_end(other.ours.get()); })) << "by another";
  int asked = 0;
  const auto gone = [&] { return asked++ == 0 ? ours() : std::string(); };
  EXPECT_FALSE(admitted(gone)) << "what the kernel has told may be of one after it";
  ::shutdown(his.theirs.get(), SHUT_WR);
  EXPECT_FALSE(admitted(ours));
}

TEST_F(Tokens, NonsenseIsNoToken) {
  std::string text;
  StoredToken row;
  for (const std::string& name :
       {std::string(), std::string("a b"), std::string(65, 'a'), std::string("a\nb")}) {
    EXPECT_EQ(authority->create(name, v1::ROLE_ADMIN, 0, text, row).error_code(),
              grpc::StatusCode::INVALID_ARGUMENT);
  }
  EXPECT_FALSE(authority->create("a", v1::ROLE_UNSPECIFIED, 0, text, row).ok());
  EXPECT_FALSE(authority->create("a", static_cast<v1::Role>(9), 0, text, row).ok());
  EXPECT_FALSE(authority->create("a", v1::ROLE_ADMIN, -1, text, row).ok());
  EXPECT_FALSE(authority->create("a", v1::ROLE_ADMIN, INT64_MAX, text, row).ok());
  v1::CreateTokenRequest asked;
  asked.set_name("a");
  asked.set_role(v1::ROLE_ADMIN);
  asked.set_machines(5);
  EXPECT_FALSE(authority->create(asked, text, row).ok()) << "no worker's";
}

TEST_F(Tokens, WhenTheyWereUsedIsKept) {
  const std::string text = make(v1::ROLE_ADMIN, "ada");
  ASSERT_TRUE(show(text).ok());
  open();
  EXPECT_GT(authority->tokens()[0].used_ms, 0);
}

}  // namespace
}  // namespace hyades::coordinator
