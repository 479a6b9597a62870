#include "cli/client/farm_client.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>

#include "cli/client/patience.h"
#include "core/base/hash.h"
#include "core/base/text.h"
#include "farm/wire.h"
#include "farm/wire_status.h"
#include "hyades/v1/admin.grpc.pb.h"
#include "hyades/v1/assets.grpc.pb.h"
#include "hyades/v1/farm.grpc.pb.h"
#include "hyades/v1/jobs.grpc.pb.h"

namespace hyades::cli {

using core::Result;
using std::chrono::milliseconds;

namespace {

constexpr milliseconds kShortCall{20'000};
constexpr milliseconds kSubmit{120'000};  // the coordinator reads the job
constexpr uint64_t kSlowestLink = 64;     // bytes/ms: bounds the deadlines of transfers

milliseconds transfer_time(uint64_t bytes) {
  return milliseconds{60'000 + static_cast<int64_t>(bytes / kSlowestLink)};
}

std::vector<std::string> hex_of(const v1::ErrorDetail& detail) {
  std::vector<std::string> names;
  for (const std::string& digest : detail.missing()) {
    if (const auto sha = farm::digest_from_wire(digest)) names.push_back(core::to_hex(*sha));
  }
  return names;
}

}  // namespace

struct FarmClient::State {
  ClientOptions options;
  std::string token;
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::Jobs::Stub> jobs;
  std::unique_ptr<v1::Assets::Stub> assets;
  std::unique_ptr<v1::Farm::Stub> farm;
  std::unique_ptr<v1::Admin::Stub> admin;
  Patience patience{0, 0};
  std::function<void(const std::string&)> tell;
  bool told = false;    ///< that the coordinator is gone
  Patience room{0, 0};  ///< with a coordinator that has no room, whatever else it answers
  bool told_room = false;

  void reached() {
    patience.reached();
    told = false;
  }

  std::string no_answer(const std::string& reason) const {
    const std::string& address = options.peer.address;
    if (const auto tls = farm::tls_trouble(reason, options.peer)) {
      return fmt::format("cannot speak with the coordinator at {}: {}", address, *tls);
    }
    const std::string trouble = farm::connection_trouble(reason, options.peer);
    if (patience.was_reached()) {
      return fmt::format("the coordinator at {} answers no more ({})", address, trouble);
    }
    return fmt::format(
        "no coordinator answers at {} ({}); --coordinator HOST:PORT or HYADES_COORDINATOR says "
        "where it is",
        address, trouble);
  }

  Failure failure(const grpc::Status& status) const {
    Failure out;
    out.missing = hex_of(farm::detail_of(status));
    out.message = status.error_message();
    out.lines = true;  // every complaint about a job, say
    switch (status.error_code()) {
      case grpc::StatusCode::INVALID_ARGUMENT:
        out.code = kBadArguments;
        break;
      case grpc::StatusCode::NOT_FOUND:
        out.code = kUnknown;
        break;
      case grpc::StatusCode::UNAUTHENTICATED:
      case grpc::StatusCode::PERMISSION_DENIED:
        out.code = kRefused;
        out.message += token.empty() ? " (--token-file FILE or HYADES_TOKEN_FILE gives a token)"
                                     : " (the token is that of " + options.peer.token_file + ")";
        break;
      case grpc::StatusCode::UNIMPLEMENTED:
        out.message = "the coordinator at " + options.peer.address + " cannot do this: it is older";
        break;
      case grpc::StatusCode::DATA_LOSS:
        out.damaged = true;
        break;
      case grpc::StatusCode::UNAVAILABLE:
      case grpc::StatusCode::DEADLINE_EXCEEDED:
        // Where a time is named the coordinator has spoken itself: what is asked for is not there
        // yet.
        if (farm::detail_of(status).retry_after_ms() != 0) break;
        out.code = kNoAnswer;
        out.message = no_answer(status.error_message());
        break;
      default:
        break;
    }
    if (out.message.empty())
      out.message = fmt::format("error {}", static_cast<int>(status.error_code()));
    return out;
  }

  /// Whether to try again, after having waited.
  bool wait_after(const grpc::Status& status) {
    if (!farm::is_retryable(status)) return false;
    const double asked = farm::detail_of(status).retry_after_ms() * 1e-3;
    const bool no_room = status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
    const double wait = (no_room ? room : patience).next_wait(Patience::Clock::now(), asked);
    if (wait < 0) return false;
    if (bool& known = no_room ? told_room : told; !known && (no_room || patience.was_reached())) {
      known = true;
      const std::string text =
          fmt::format("{} ({}): trying for up to {}", options.peer.address,
                      farm::connection_trouble(status.error_message(), options.peer),
                      core::format_duration(options.later_patience));
      tell ? tell(text) : static_cast<void>(std::fprintf(stderr, "%s\n", text.c_str()));
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(wait));
    return true;
  }

  /// `once` until it succeeds, fails for good, or patience ends.
  Outcome persist(milliseconds timeout,
                  const std::function<grpc::Status(grpc::ClientContext&)>& once) {
    for (bool refused = false;;) {
      grpc::ClientContext context;
      farm::prepare(context, token, timeout);
      const grpc::Status status = once(context);
      if (status.ok()) {
        reached();
        if (refused) room.reached();
        return std::nullopt;
      }
      refused = refused || status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
      if (!wait_after(status)) return failure(status);
    }
  }

  template <class Stub, class Request, class Response>
  Outcome call(Stub& stub,
               grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
               const Request& request, Response& response, milliseconds timeout = kShortCall) {
    return persist(timeout, [&](grpc::ClientContext& context) {
      response.Clear();
      return (stub.*method)(&context, request, &response);
    });
  }

  /// Every message of a server's stream until `on_message` returns false; an error that it leaves
  /// in `stopped` ends everything.
  template <class Message, class Begin>
  Outcome stream(milliseconds timeout, const Begin& begin,
                 const std::function<bool(const Message&)>& on_message, const Outcome& stopped) {
    Outcome outcome = persist(timeout, [&](grpc::ClientContext& context) {
      const auto reader = begin(context);
      Message message;
      while (reader->Read(&message)) {
        reached();
        if (on_message(message)) continue;
        context.TryCancel();
        while (reader->Read(&message)) {
        }
        (void)reader->Finish();
        return grpc::Status::OK;
      }
      return reader->Finish();
    });
    return stopped ? stopped : outcome;
  }
};

Result<std::unique_ptr<FarmClient>> FarmClient::open(const ClientOptions& options) {
  auto state = std::make_unique<State>();
  state->options = options;
  auto token = farm::read_token(options.peer.token_file);
  if (!token) return token.error();
  state->token = *token;
  auto channel = farm::connect(options.peer);
  if (!channel) return channel.error();
  state->channel = *channel;
  state->jobs = v1::Jobs::NewStub(*channel);
  state->assets = v1::Assets::NewStub(*channel);
  state->farm = v1::Farm::NewStub(*channel);
  state->admin = v1::Admin::NewStub(*channel);
  state->patience = Patience(options.first_patience, options.later_patience);
  state->room = Patience(options.later_patience, options.later_patience);
  return std::unique_ptr<FarmClient>(new FarmClient(std::move(state)));
}

FarmClient::FarmClient(std::unique_ptr<State> state) : state_(std::move(state)) {}
FarmClient::~FarmClient() = default;

void FarmClient::on_notice(std::function<void(const std::string&)> tell) {
  state_->tell = std::move(tell);
}

Outcome FarmClient::submit(const v1::SubmitRequest& request, v1::SubmitResponse& response) {
  return state_->call(*state_->jobs, &v1::Jobs::Stub::Submit, request, response, kSubmit);
}

Outcome FarmClient::list(const v1::ListJobsRequest& request, v1::ListJobsResponse& response) {
  return state_->call(*state_->jobs, &v1::Jobs::Stub::List, request, response);
}

Outcome FarmClient::get(uint64_t job, v1::GetJobResponse& response) {
  v1::GetJobRequest request;
  request.set_job(job);
  response.Clear();
  v1::GetJobResponse part;
  do {
    auto failure = state_->call(*state_->jobs, &v1::Jobs::Stub::Get, request, part);
    if (failure) return failure;
    response.mutable_job()->Swap(part.mutable_job());
    response.mutable_frames()->MergeFrom(part.frames());
    if (part.frames_size() > 0) request.set_after(part.frames().rbegin()->frame());
  } while (part.more() && part.frames_size() > 0);
  return std::nullopt;
}

Outcome FarmClient::act(Action action, uint64_t job, v1::JobResponse& response) {
  v1::JobRequest request;
  request.set_job(job);
  const auto call = [&](auto method) {
    return state_->call(*state_->jobs, method, request, response);
  };
  switch (action) {
    case Action::pause:
      return call(&v1::Jobs::Stub::Pause);
    case Action::resume:
      return call(&v1::Jobs::Stub::Resume);
    case Action::cancel:
      return call(&v1::Jobs::Stub::Cancel);
    case Action::retry:
      return call(&v1::Jobs::Stub::Retry);
  }
  return Failure{kFailed, "no such action"};
}

Outcome FarmClient::set_priority(uint64_t job, int32_t priority, v1::JobResponse& response) {
  v1::SetPriorityRequest request;
  request.set_job(job);
  request.set_priority(priority);
  return state_->call(*state_->jobs, &v1::Jobs::Stub::SetPriority, request, response);
}

Outcome FarmClient::remove(uint64_t job) {
  v1::JobRequest request;
  request.set_job(job);
  v1::DeleteJobResponse response;
  return state_->call(*state_->jobs, &v1::Jobs::Stub::Delete, request, response);
}

Outcome FarmClient::explain(uint64_t job, v1::ExplainResponse& response) {
  v1::JobRequest request;
  request.set_job(job);
  return state_->call(*state_->jobs, &v1::Jobs::Stub::Explain, request, response);
}

Outcome FarmClient::watch(uint64_t job,
                          const std::function<bool(const v1::WatchEvent&)>& on_event) {
  v1::WatchRequest request;
  request.set_job(job);
  return state_->stream<v1::WatchEvent>(
      milliseconds{0}, [&](grpc::ClientContext& c) { return state_->jobs->Watch(&c, request); },
      on_event, std::nullopt);
}

Outcome FarmClient::outputs(const v1::OutputsRequest& request,
                            const std::function<Outcome(const v1::OutputFile&)>& on_file) {
  Outcome stopped;
  return state_->stream<v1::OutputFile>(
      request.follow() ? milliseconds{0} : kSubmit,
      [&](grpc::ClientContext& c) { return state_->jobs->Outputs(&c, request); },
      [&](const v1::OutputFile& file) { return !(stopped = on_file(file)); }, stopped);
}

Outcome FarmClient::fetch(v1::FetchRequest request, uint64_t size,
                          const std::function<Outcome(const std::string&)>& on_bytes) {
  Outcome stopped;
  const auto on_chunk = [&](const v1::Chunk& chunk) {
    if (chunk.offset() != request.offset() || chunk.data().size() > size - request.offset()) {
      stopped = Failure{
          kFailed, request.path() + ": the coordinator sends other bytes than those asked for"};
      return false;
    }
    request.set_offset(request.offset() + chunk.data().size());
    stopped = on_bytes(chunk.data());
    return !stopped;
  };
  return state_->stream<v1::Chunk>(
      transfer_time(size), [&](grpc::ClientContext& c) { return state_->jobs->Fetch(&c, request); },
      on_chunk, stopped);
}

Outcome FarmClient::film(uint64_t job, int32_t frame, v1::FilmHeader& header, std::string& bytes,
                         const std::function<void(uint64_t)>& on_progress) {
  v1::FilmRequest request;
  request.set_job(job);
  request.set_frame(frame);
  Outcome stopped;
  return state_->stream<v1::FilmPart>(
      transfer_time(farm::kMaxResultBytes),
      [&](grpc::ClientContext& c) {
        header.Clear();
        bytes.clear();
        return state_->jobs->Film(&c, request);
      },
      [&](const v1::FilmPart& part) {
        if (part.has_header()) {
          header = part.header();
        } else if (part.chunk().offset() == bytes.size() &&
                   part.chunk().data().size() <= header.size() - bytes.size()) {
          bytes += part.chunk().data();
          if (on_progress) on_progress(part.chunk().data().size());
        } else {
          stopped = Failure{kFailed, "the coordinator sends a film in pieces that do not fit"};
        }
        return !stopped;
      },
      stopped);
}

Outcome FarmClient::logs(v1::LogsRequest request,
                         const std::function<void(const v1::LogLine&)>& on_line) {
  return state_->stream<v1::LogLine>(
      request.follow() ? milliseconds{0} : kSubmit,
      [&](grpc::ClientContext& c) { return state_->jobs->Logs(&c, request); },
      [&](const v1::LogLine& line) {
        on_line(line);
        request.set_after(line.number());  // after a break those told already do not come again
        return true;
      },
      std::nullopt);
}

Outcome FarmClient::timeline(const v1::ListTimelineRequest& request,
                             v1::ListTimelineResponse& response) {
  return state_->call(*state_->jobs, &v1::Jobs::Stub::ListTimeline, request, response);
}

Outcome FarmClient::find_missing(const v1::FindMissingRequest& request,
                                 v1::FindMissingResponse& response) {
  return state_->call(*state_->assets, &v1::Assets::Stub::FindMissing, request, response);
}

Outcome FarmClient::upload(const core::AssetRecord& file, std::istream& input, uint64_t offset,
                           const std::function<void(uint64_t)>& on_progress) {
  const auto digest = farm::digest_from_hex(file.sha256);
  if (!digest) return Failure{kFailed, digest.error().message};
  const Failure changed{kFailed, file.reference + " changed while it was being sent: submit again"};
  input.seekg(static_cast<std::streamoff>(offset));
  if (!input) return Failure{kFailed, file.reference + ": cannot be read"};

  grpc::ClientContext context;
  farm::prepare(context, state_->token, transfer_time(file.size));
  v1::UploadResponse response;
  const auto writer = state_->assets->Upload(&context, &response);
  v1::UploadPart part;
  part.set_sha256(farm::to_wire(*digest));
  part.set_size(file.size);
  uint64_t sent = offset;
  do {
    std::string& data = *part.mutable_chunk()->mutable_data();
    data.resize(std::min(farm::kMaxChunkBytes, file.size - sent));
    input.read(data.data(), static_cast<std::streamsize>(data.size()));
    if (static_cast<size_t>(input.gcount()) != data.size()) {
      context.TryCancel();
      (void)writer->Finish();
      return changed;
    }
    part.mutable_chunk()->set_offset(sent);
    if (!writer->Write(part)) break;
    sent += data.size();
    on_progress(data.size());
    part.Clear();
  } while (sent < file.size);
  writer->WritesDone();
  const grpc::Status status = writer->Finish();
  if (status.ok()) {
    state_->reached();
    state_->room.reached();
    return std::nullopt;
  }
  Failure out = state_->failure(status);
  if (status.error_code() == grpc::StatusCode::DATA_LOSS) out.message = changed.message;
  // The caller asks how far it came and goes on from there. What the coordinator said may be held
  // by a stream that it does not know to be broken yet: then everything has to come again.
  out.from_start = status.error_code() == grpc::StatusCode::OUT_OF_RANGE && offset > 0;
  out.again = state_->wait_after(status);
  return out;
}

Outcome FarmClient::whoami(v1::WhoAmIResponse& response) {
  return state_->call(*state_->admin, &v1::Admin::Stub::WhoAmI, v1::WhoAmIRequest(), response);
}

Outcome FarmClient::create_token(const v1::CreateTokenRequest& request,
                                 v1::CreateTokenResponse& response) {
  // A call of no effect first: a coordinator that has just gone is waited for.
  v1::WhoAmIResponse me;
  if (Outcome failed = whoami(me)) return failed;
  grpc::ClientContext context;
  farm::prepare(context, state_->token, kShortCall);
  const grpc::Status status = state_->admin->CreateToken(&context, request, &response);
  return status.ok() ? Outcome() : state_->failure(status);
}

Outcome FarmClient::tokens(v1::ListTokensResponse& response) {
  return state_->call(*state_->admin, &v1::Admin::Stub::ListTokens, v1::ListTokensRequest(),
                      response);
}

Outcome FarmClient::revoke_token(const std::string& id, v1::RevokeTokenResponse& response) {
  v1::RevokeTokenRequest request;
  request.set_id(id);
  return state_->call(*state_->admin, &v1::Admin::Stub::RevokeToken, request, response);
}

Outcome FarmClient::audit(int64_t since_ms,
                          const std::function<void(const v1::AuditEntry&)>& on_entry) {
  v1::AuditRequest request;
  request.set_since_ms(since_ms);
  return state_->stream<v1::AuditEntry>(
      transfer_time(farm::kMaxResultBytes),
      [&](grpc::ClientContext& c) { return state_->admin->Audit(&c, request); },
      [&](const v1::AuditEntry& entry) {
        on_entry(entry);
        request.set_since_ms(entry.time_ms() + 1);
        return true;
      },
      std::nullopt);
}

Outcome FarmClient::info(v1::InfoResponse& response) {
  return state_->call(*state_->farm, &v1::Farm::Stub::Info, v1::InfoRequest(), response);
}

Outcome FarmClient::workers(v1::WorkersResponse& response) {
  response.Clear();
  v1::WorkersRequest request;
  for (;;) {
    v1::WorkersResponse page;
    Outcome failed = state_->call(*state_->farm, &v1::Farm::Stub::Workers, request, page);
    if (failed) return failed;
    for (v1::Worker& worker : *page.mutable_workers()) *response.add_workers() = std::move(worker);
    if (page.next_after() <= request.after()) break;
    request.set_after(page.next_after());
  }
  std::sort(response.mutable_workers()->begin(), response.mutable_workers()->end(),
            [](const v1::Worker& a, const v1::Worker& b) {
              return a.name() != b.name() ? a.name() < b.name() : a.id() < b.id();
            });
  return std::nullopt;
}

Outcome FarmClient::act(WorkerAction action, const v1::WorkerRequest& request,
                        v1::WorkerResponse& response) {
  const auto method = action == WorkerAction::drain        ? &v1::Farm::Stub::DrainWorker
                      : action == WorkerAction::quarantine ? &v1::Farm::Stub::QuarantineWorker
                                                           : &v1::Farm::Stub::ReleaseWorker;
  return state_->call(*state_->farm, method, request, response);
}

}  // namespace hyades::cli
