#pragma once

#include <cstdint>
#include <functional>
#include <istream>
#include <memory>
#include <string>

#include "cli/client/failure.h"
#include "core/base/assets.h"
#include "core/base/result.h"
#include "farm/channel.h"
#include "hyades/v1/admin.pb.h"
#include "hyades/v1/assets.pb.h"
#include "hyades/v1/farm.pb.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::cli {

/// Where the coordinator is and how long to go on trying.
struct ClientOptions {
  farm::Peer peer;
  double first_patience = 3;    ///< s without any answer, for a coordinator that was never reached
  double later_patience = 300;  ///< s, for one that was there: it may be starting again
};

/// The coordinator as the commands see it: what is worth another try is tried again, with jittered
/// backoff, until it succeeds or patience ends; every call has a deadline or (streams that follow
/// something) keepalive. Streams that break go on where they were. One thread at a time.
class FarmClient {
 public:
  static core::Result<std::unique_ptr<FarmClient>> open(const ClientOptions& options);
  ~FarmClient();

  /// Who tells the person that the coordinator is gone and tries go on; standard error if nobody.
  void on_notice(std::function<void(const std::string&)> tell);

  Outcome submit(const v1::SubmitRequest& request, v1::SubmitResponse& response);
  Outcome list(const v1::ListJobsRequest& request, v1::ListJobsResponse& response);
  Outcome get(uint64_t job, v1::GetJobResponse& response);

  enum class Action { pause, resume, cancel, retry };
  Outcome act(Action action, uint64_t job, v1::JobResponse& response);
  Outcome set_priority(uint64_t job, int32_t priority, v1::JobResponse& response);
  Outcome remove(uint64_t job);
  Outcome explain(uint64_t job, v1::ExplainResponse& response);

  /// Calls `on_event` until it returns false or the stream ends, which is where the job does.
  Outcome watch(uint64_t job, const std::function<bool(const v1::WatchEvent&)>& on_event);

  /// The finished files; after a break with `follow` those that were told already come again.
  Outcome outputs(const v1::OutputsRequest& request,
                  const std::function<Outcome(const v1::OutputFile&)>& on_file);

  /// The bytes of `request` from its offset on, in order; an error of `on_bytes` ends it.
  Outcome fetch(v1::FetchRequest request, uint64_t size,
                const std::function<Outcome(const std::string&)>& on_bytes);

  /// The merged film of a frame as it is now: what it belongs to, and its bytes (film_codec.h).
  /// `on_progress` hears how many more have come.
  Outcome film(uint64_t job, int32_t frame, v1::FilmHeader& header, std::string& bytes,
               const std::function<void(uint64_t)>& on_progress = {});

  /// A page of what was done for a job.
  Outcome timeline(const v1::ListTimelineRequest& request, v1::ListTimelineResponse& response);

  Outcome logs(v1::LogsRequest request, const std::function<void(const v1::LogLine&)>& on_line);

  Outcome find_missing(const v1::FindMissingRequest& request, v1::FindMissingResponse& response);

  /// One try to send `input`, the bytes of `file`, from `offset` on. `on_progress` hears how many
  /// more bytes have gone.
  Outcome upload(const core::AssetRecord& file, std::istream& input, uint64_t offset,
                 const std::function<void(uint64_t)>& on_progress);

  Outcome whoami(v1::WhoAmIResponse& response);
  /// Not tried again: a second one would be another token.
  Outcome create_token(const v1::CreateTokenRequest& request, v1::CreateTokenResponse& response);
  Outcome tokens(v1::ListTokensResponse& response);
  Outcome revoke_token(const std::string& id, v1::RevokeTokenResponse& response);
  /// The oldest first; after a break from the last one's time on.
  Outcome audit(int64_t since_ms, const std::function<void(const v1::AuditEntry&)>& on_entry);

  /// Of the coordinator itself.
  Outcome info(v1::InfoResponse& response);
  Outcome workers(v1::WorkersResponse& response);
  enum class WorkerAction { drain, quarantine, release };
  Outcome act(WorkerAction action, const v1::WorkerRequest& request, v1::WorkerResponse& response);

 private:
  struct State;
  explicit FarmClient(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace hyades::cli
