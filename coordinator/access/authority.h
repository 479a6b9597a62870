#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/access/audit_log.h"
#include "coordinator/access/caller.h"
#include "coordinator/access/peer_user.h"
#include "coordinator/job_store/job_store.h"
#include "core/base/mutex.h"
#include "core/base/result.h"
#include "farm/token_bucket.h"

namespace hyades::coordinator {

class Authority;

/// By what a worker is known: whose word it is that a film is right, or that a unit cannot be
/// rendered.
struct WorkerCredential {
  /// Equal for workers whose words count as one. Empty: nobody else has it, as on farms where
  /// whoever may work may do everything.
  std::string name{};
  /// Names the token or pool that the worker came by, which can bring any number of workers, also
  /// such as have names of their own. Empty: as `name` says.
  std::string origin{};
  std::string machine_token{};  ///< to be kept by the worker and shown from now on; empty: none
  /// Whose the worker is: nobody else may come under its id. Empty: anybody's, as the farm asks for
  /// no token.
  std::string owner{};
  /// The id of the token that it has joined with, by which at most `machines` workers may be here;
  /// empty: it has not joined.
  std::string joined_with{};
  uint32_t machines = 0;
};

/// A caller's open stream, as long as this lives: it hears when its caller may stay no longer.
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
  /// Who may come in, and who hears of it.
  struct Options {
    std::string shared_token{};  ///< that --token-file gives: one for all roles; empty: none
    bool beyond = false;         ///< the coordinator listens beyond this machine
    bool plain = false;          ///< ... without TLS
    /// Where no token is asked for only the user that has started this process may come in, and
    /// root, who are told by the kernel (peer_user.h).
    bool owner_only = false;
    /// Hears unguarded(), at once and whenever it has changed; called by any thread.
    std::function<void(const std::string&)> tell_unguarded{};
    /// Hears of a token that is used and will expire soon, once a day; called by any thread.
    std::function<void(const std::string&)> tell_expiring{};
    /// Where it is kept who did what (audit_log.h); empty: nowhere.
    std::string audit_folder{};
    /// What machines' tokens are made with (token.h): secret, and best in no back-up. Empty: one
    /// that ends with this, so that machines join anew then.
    std::string machine_key{};
  };
  /// Reads the tokens; an error where that fails. `store` has to outlive it.
  static core::Result<std::unique_ptr<Authority>> open(JobStore& store, Options options);
  /// All visits have to be over.
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

  /// Admits who shows `authorization` ("Bearer TOKEN"; empty: nothing) from the address that
  /// `caller` has: OK with the rest of `caller`, or UNAUTHENTICATED. Where no token is needed
  /// everybody is an admin without a name; with `owner_only` it is told by the connection, of which
  /// `own` tells our end (none: nobody comes in). Whose neighbourhood has shown too many tokens
  /// that are none is told RESOURCE_EXHAUSTED instead, and when to come again; a token that is one
  /// is always taken.
  grpc::Status admit(std::string_view authorization, Caller& caller, const OwnEnd& own = {});
  /// Admits who has shown the token of this id before: OK with all of `caller` but the address, or
  /// UNAUTHENTICATED where the token is of no use any more.
  grpc::Status admit_known(const std::string& token_id, Caller& caller);

  /// By what a worker of this id is known that `caller` wants to be. One that has joined with a
  /// token of many, and `keeps` one of its own, is given that. PERMISSION_DENIED where the caller's
  /// token is another worker's.
  grpc::Status admit_worker(const Caller& caller, const std::string& worker, bool keeps,
                            WorkerCredential& credential) const;

  /// Registers a caller's open stream. `leave` is called once the caller's token is of no use any
  /// more, perhaps within this call, by any thread; it must not wait, and not end the visit itself.
  std::unique_ptr<Visit> visit(const Caller& caller,
                               std::function<void(const grpc::Status&)> leave);

  /// Has all streams of this session (Caller::session) end; of none where it is empty.
  void end_session(const std::string& session);

  // These may wait for the store.

  /// Makes a token: `text` is what its owner shows, `row` what is stored of it. INVALID_ARGUMENT as
  /// make_token() has it, FAILED_PRECONDITION where it would be the farm's first and not an
  /// admin's.
  grpc::Status create(const v1::CreateTokenRequest& asked, std::string& text, StoredToken& row);
  grpc::Status create(const std::string& name, v1::Role role, int64_t lifetime_ms,
                      std::string& text, StoredToken& row);
  /// Makes the token useless from here on, even where the store refuses (UNAVAILABLE: it may come
  /// back after a restart). NOT_FOUND where there is none of this id.
  grpc::Status revoke(const std::string& id, StoredToken& row);
  /// All that are known, the oldest first.
  std::vector<StoredToken> tokens() const;

 private:
  friend class Visit;
  struct Known {
    StoredToken row;
    int64_t noted_ms = 0;  ///< used_ms as it is stored
    int64_t told_ms = 0;   ///< when tell_expiring has heard of it
  };
  struct OpenStream {
    std::string token_id;
    std::string session;  ///< empty: none
    std::function<void(const grpc::Status&)> leave;
  };

  Authority(JobStore& store, Options options);
  grpc::Status refuse_unknown(const std::string& address);
  grpc::Status admit_without_token(Caller& caller, const OwnEnd& own);
  void take_in(const StoredToken& row) HYADES_REQUIRES(mutex_);
  grpc::Status check(const std::string& token_id, int64_t now_ms) const HYADES_REQUIRES(mutex_);
  core::Status make_room(int64_t now_ms);
  void end_expired();
  void store_uses();
  void tell_expiring();
  void watch_expiry();

  JobStore& store_;
  const Options options_;
  std::unique_ptr<AuditLog> audit_;
  mutable core::Mutex mutex_;
  std::map<std::string, Known> tokens_ HYADES_GUARDED_BY(mutex_);
  bool stop_ HYADES_GUARDED_BY(mutex_) = false;
  core::CondVar wake_;

  core::Mutex wrong_mutex_;
  /// Of tokens that were none, by neighbourhood_of() an address.
  std::map<std::string, farm::TokenBucket> wrong_ HYADES_GUARDED_BY(wrong_mutex_);

  core::Mutex streams_mutex_;  ///< taken before mutex_
  std::map<uint64_t, OpenStream> streams_ HYADES_GUARDED_BY(streams_mutex_);
  uint64_t next_stream_ HYADES_GUARDED_BY(streams_mutex_) = 1;

  core::Mutex change_mutex_;  ///< one change at a time; taken first
  std::thread thread_;        ///< watch_expiry()
};

}  // namespace hyades::coordinator
