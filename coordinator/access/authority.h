#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/access/audit_log.h"
#include "coordinator/access/caller.h"
#include "coordinator/state/job_store.h"
#include "core/base/result.h"

namespace hyades::coordinator {

class Authority;

/// Somebody who stays, with a stream open: he is told when he may not any longer. Ends with it.
class Visit {
 public:
  Visit(Authority& authority, uint64_t number) : authority_(authority), number_(number) {}
  ~Visit();
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;

 private:
  Authority& authority_;
  uint64_t number_;
};

/// Whose token is whose: all tokens in memory, as they are stored. Expiry and revocation hold at
/// once, for streams that are open too. Thread-safe.
class Authority {
 public:
  struct Options {
    std::string shared_token{};  ///< that --token-file gives: one for all roles; empty: none
    bool beyond = false;         ///< the coordinator listens beyond this machine
    bool plain = false;          ///< ... without TLS
    /// Hears unguarded(), at once and whenever it has changed; called by any thread.
    std::function<void(const std::string&)> tell_unguarded{};
    /// Hears of a token that is used and will expire soon, once a day; called by any thread.
    std::function<void(const std::string&)> tell_expiring{};
    /// Where it is kept who did what (audit_log.h); empty: nowhere.
    std::string audit_folder{};
  };
  /// An error where the tokens cannot be read. `store` outlives it.
  static core::Result<std::unique_ptr<Authority>> open(JobStore& store, Options options);
  /// All visits have ended.
  ~Authority();
  Authority(const Authority&) = delete;
  Authority& operator=(const Authority&) = delete;

  /// Whether callers need a token: there is one, or has been.
  bool guarded() const;
  /// Whether anybody may come in as an admin: the shared token, or one that is in use.
  bool has_admin() const;
  /// How strangers may listen or act; empty: they may not.
  std::string unguarded() const;

  /// Where it is kept who did what; null where it is not.
  AuditLog* audit() { return audit_.get(); }

  /// Who shows `authorization` ("Bearer TOKEN"; empty: nothing): OK with all of `caller` but the
  /// address, or UNAUTHENTICATED. Where no token is needed he is an admin without a name.
  grpc::Status admit(std::string_view authorization, Caller& caller);
  /// The same for who has shown the token of this id before.
  grpc::Status admit_known(const std::string& token_id, Caller& caller);

  /// Registers who stays. `leave` is called once his token is of no use any more, perhaps within
  /// this call, by any thread; it must not wait, and not end the visit itself.
  std::unique_ptr<Visit> visit(const Caller& caller,
                               std::function<void(const grpc::Status&)> leave);

  /// Those who stay in this session (Caller::session) have to go: it was signed out.
  void end_session(const std::string& session);

  // These may wait for the store.

  /// The token and what is stored of it. INVALID_ARGUMENT as check_token() has it,
  /// FAILED_PRECONDITION where it would be the farm's first and not an admin's.
  grpc::Status create(const std::string& name, v1::Role role, int64_t lifetime_ms,
                      std::string& text, StoredToken& row);
  /// Holds from here on, even where the store refuses (UNAVAILABLE: it may come back after a
  /// restart). NOT_FOUND.
  grpc::Status revoke(const std::string& id, StoredToken& row);
  /// The oldest first.
  std::vector<StoredToken> tokens() const;

 private:
  friend class Visit;
  struct Known {
    StoredToken row;
    int64_t noted_ms = 0;  ///< used_ms as it is stored
    int64_t told_ms = 0;   ///< when tell_expiring has heard of it
  };
  struct Stay {
    std::string token_id;
    std::string session;  ///< empty: none
    std::function<void(const grpc::Status&)> leave;
  };

  Authority(JobStore& store, Options options);
  void take_in(const StoredToken& row);
  grpc::Status check(const std::string& token_id, int64_t now_ms) const;
  Caller as_caller(const StoredToken& row) const;
  core::Status make_room(int64_t now_ms);
  void end_stays();
  void store_uses();
  void tell_expiring();
  void mind();

  JobStore& store_;
  const Options options_;
  std::unique_ptr<AuditLog> audit_;
  mutable std::mutex mutex_;
  std::map<std::string, Known> tokens_;
  bool stop_ = false;
  std::condition_variable wake_;

  std::mutex stays_mutex_;  ///< taken before mutex_
  std::map<uint64_t, Stay> stays_;
  uint64_t next_stay_ = 1;

  std::mutex change_mutex_;  ///< one change at a time; taken first
  std::thread thread_;       ///< minds expiry, and stores when tokens were used
};

}  // namespace hyades::coordinator
