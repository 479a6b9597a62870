#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <google/protobuf/message.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "cli/client/failure.h"
#include "cli/client/patience.h"
#include "core/base/assets.h"
#include "core/base/machine.h"
#include "core/base/result.h"
#include "core/film/film_codec.h"
#include "farm/channel.h"
#include "farm/channels.h"
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
  /// Of a film, or of one list, that is kept in memory: a coordinator may be hostile, and tell of
  /// more than there is anywhere.
  uint64_t most_bytes = core::half_of_memory();
};

/// The coordinator as the commands see it: what is worth another try is tried again, with jittered
/// backoff, until it succeeds or patience ends; every call has a deadline or (streams that follow
/// something) keepalive. Where it has several addresses each is tried before that is waited for.
/// Streams that break go on where they were. One thread at a time.
class FarmClient {
 public:
  static constexpr std::chrono::seconds kShortCall{20};
  static constexpr std::chrono::seconds kLongCall{120};  ///< the coordinator reads a job

  static core::Result<std::unique_ptr<FarmClient>> open(const ClientOptions& options);

  /// Who tells the person that the coordinator is gone and tries go on; standard error if nobody.
  void on_notice(std::function<void(const std::string&)> tell) { tell_ = std::move(tell); }

  /// One method of the wire, such as "Jobs/Pause"; a try takes `timeout` at most.
  Outcome call(const char* method, const google::protobuf::Message& request,
               google::protobuf::Message& response, std::chrono::milliseconds timeout = kShortCall);

  /// What of a film may be kept, packed and unpacked together [bytes].
  core::FilmLimits film_limits(const std::string& packed) const;

  /// Counts a part of a list in `bytes`; a failure where all of them are too much to keep.
  Outcome count_part(const google::protobuf::Message& part, uint64_t& bytes) const;

  /// The job with all its frames.
  Outcome get(uint64_t job, v1::GetJobResponse& response);

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

  /// Calls `on_line` until it returns false or the log ends.
  Outcome logs(v1::LogsRequest request, const std::function<bool(const v1::LogLine&)>& on_line);

  /// One try to send `input`, the bytes of `file`, from `offset` on. `on_progress` hears how many
  /// more bytes have gone.
  Outcome upload(const core::AssetRecord& file, std::istream& input, uint64_t offset,
                 const std::function<void(uint64_t)>& on_progress);

  /// Not tried again: a second one would be another token.
  Outcome create_token(const v1::CreateTokenRequest& request, v1::CreateTokenResponse& response);
  /// The oldest first; after a break from the last one's time on.
  Outcome audit(int64_t since_ms, const std::function<void(const v1::AuditEntry&)>& on_entry);

  /// All workers, by name.
  Outcome workers(v1::WorkersResponse& response);

  /// How long one goes on trying where nothing gets on [s].
  double patience() const { return options_.later_patience; }

 private:
  FarmClient(const ClientOptions& options, std::string token,
             std::shared_ptr<farm::Channels> channels);

  /// Where the next try goes.
  const std::shared_ptr<grpc::Channel>& channel();
  void reached();
  std::string no_answer(const std::string& reason) const;
  Failure too_much(const char* what) const;
  Failure failure(const grpc::Status& status) const;
  /// Whether to try again, after having waited.
  bool wait_after(const grpc::Status& status);
  /// `once` until it succeeds, fails for good, or patience ends.
  Outcome persist(std::chrono::milliseconds timeout,
                  const std::function<grpc::Status(grpc::ClientContext&)>& once);
  /// Every message of a server's stream until `on_message` returns false; an error that it leaves
  /// in `stopped` ends everything. Another try begins with the `request` as it is then.
  template <class Message, class OnMessage>
  Outcome stream(const char* method, const google::protobuf::Message& request,
                 std::chrono::milliseconds timeout, const OnMessage& on_message,
                 const Outcome& stopped = std::nullopt);

  const ClientOptions options_;
  const std::string token_;
  const std::shared_ptr<farm::Channels> channels_;
  farm::Channels::Way way_;  ///< of the last try
  /// Of an address, as it is told where no other one answers: that a coordinator stands by, and is
  /// silent, is no reason.
  std::string tls_trouble_;
  Patience patience_;
  std::function<void(const std::string&)> tell_;
  bool told_ = false;  ///< that the coordinator is gone
  Patience room_;      ///< with a coordinator that has no room, whatever else it answers
  bool told_room_ = false;
};

}  // namespace hyades::cli
