#include "cli/client/farm_client.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ios>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/client/byte_call.h"
#include "core/base/hash.h"
#include "core/base/printable.h"
#include "core/base/text.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::cli {

using core::Result;
using std::chrono::milliseconds;

namespace {

constexpr milliseconds kAsLongAsItLives{0};
constexpr uint64_t kSlowestLink = 64;  // bytes/ms: bounds the deadlines of transfers

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

/// Seconds without a first answer. Of several coordinators for a moment none leads.
double first_patience(const ClientOptions& options, size_t addresses) {
  constexpr double kUntilAnotherLeads = 15.0;
  if (addresses == 1) return options.first_patience;
  return std::max(options.first_patience, std::min(kUntilAnotherLeads, options.later_patience));
}

std::string cannot_speak(const std::string& address, const std::string& tls_trouble) {
  return fmt::format("cannot speak with the coordinator at {}: {}", address, tls_trouble);
}

grpc::Status call_once(const std::shared_ptr<grpc::Channel>& channel, grpc::ClientContext& context,
                       const char* method, const google::protobuf::Message& request,
                       google::protobuf::Message& response) {
  response.Clear();
  ByteCall call(channel, context, method);
  (void)call.write(request, true);
  const bool answered = call.read(response);
  const grpc::Status status = call.finish();
  if (!status.ok() || answered) return status;
  return {grpc::StatusCode::INTERNAL, "the coordinator says nothing"};
}

}  // namespace

FarmClient::FarmClient(const ClientOptions& options, std::string token,
                       std::shared_ptr<farm::Channels> channels)
    : options_(options),
      token_(std::move(token)),
      channels_(std::move(channels)),
      way_(channels_->current()),
      patience_(first_patience(options, channels_->size()), options.later_patience),
      room_(options.later_patience, options.later_patience) {}

Result<std::unique_ptr<FarmClient>> FarmClient::open(const ClientOptions& options) {
  auto token = farm::read_token(options.peer.token_file);
  if (!token) return token.error();
  auto channels = farm::Channels::open(options.peer);
  if (!channels) return channels.error();
  return std::unique_ptr<FarmClient>(new FarmClient(options, *token, *channels));
}

const std::shared_ptr<grpc::Channel>& FarmClient::channel() {
  way_ = channels_->current();
  return way_.channel;
}

void FarmClient::reached() {
  patience_.reached();
  told_ = false;
  tls_trouble_.clear();
}

std::string FarmClient::no_answer(const std::string& reason) const {
  const std::string& address = options_.peer.address;
  if (const auto tls = farm::tls_trouble(reason, options_.peer)) {
    return cannot_speak(way_.address, *tls);
  }
  if (!tls_trouble_.empty()) return tls_trouble_;
  const std::string trouble = farm::connection_trouble(reason, options_.peer);
  if (patience_.was_reached()) {
    return fmt::format("the coordinator at {} answers no more ({})", address, trouble);
  }
  return fmt::format(
      "no coordinator answers at {} ({}); --coordinator HOST:PORT or HYADES_COORDINATOR says "
      "where it is",
      address, trouble);
}

Failure FarmClient::failure(const grpc::Status& status) const {
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
      out.message += token_.empty() ? " (--token-file FILE or HYADES_TOKEN_FILE gives a token)"
                                    : " (the token is that of " + options_.peer.token_file + ")";
      break;
    case grpc::StatusCode::UNIMPLEMENTED:
      out.message = "the coordinator at " + way_.address + " cannot do this: it is older";
      break;
    case grpc::StatusCode::DATA_LOSS:
      out.damaged = true;
      break;
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      if (!farm::is_unanswered(status)) break;  // what is asked for is not there yet
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

bool FarmClient::wait_after(const grpc::Status& status) {
  if (!farm::is_retryable(status)) return false;
  if (farm::is_unanswered(status) && channels_->failed(way_)) {
    const auto tls = farm::tls_trouble(status.error_message(), options_.peer);
    if (tls) tls_trouble_ = cannot_speak(way_.address, *tls);
    return true;
  }
  const double asked = farm::detail_of(status).retry_after_ms() * 1e-3;
  const bool no_room = status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
  const double wait = (no_room ? room_ : patience_).next_wait(Patience::Clock::now(), asked);
  if (wait < 0) return false;
  if (bool& known = no_room ? told_room_ : told_; !known && (no_room || patience_.was_reached())) {
    known = true;
    const std::string text = fmt::format(
        "{} ({}): trying for up to {}", options_.peer.address,
        core::printable(farm::connection_trouble(status.error_message(), options_.peer)),
        core::format_duration(options_.later_patience));
    tell_ ? tell_(text) : static_cast<void>(std::fprintf(stderr, "%s\n", text.c_str()));
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(wait));
  return true;
}

Outcome FarmClient::persist(milliseconds timeout,
                            const std::function<grpc::Status(grpc::ClientContext&)>& once) {
  for (bool refused = false;;) {
    grpc::ClientContext context;
    farm::prepare(context, token_, timeout);
    const grpc::Status status = once(context);
    if (status.ok()) {
      reached();
      channels_->answered();
      if (refused) room_.reached();
      return std::nullopt;
    }
    refused = refused || status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
    if (!wait_after(status)) return failure(status);
  }
}

Outcome FarmClient::call(const char* method, const google::protobuf::Message& request,
                         google::protobuf::Message& response, milliseconds timeout) {
  return persist(timeout, [&](grpc::ClientContext& context) {
    return call_once(channel(), context, method, request, response);
  });
}

template <class Message, class OnMessage>
Outcome FarmClient::stream(const char* method, const google::protobuf::Message& request,
                           milliseconds timeout, const OnMessage& on_message,
                           const Outcome& stopped) {
  Outcome outcome = persist(timeout, [&](grpc::ClientContext& context) {
    ByteCall call(channel(), context, method);
    (void)call.write(request, true);
    Message message;
    while (call.read(message)) {
      reached();
      if (on_message(message)) continue;
      call.cancel();
      (void)call.finish();
      return grpc::Status::OK;
    }
    return call.finish();
  });
  return stopped ? stopped : outcome;
}

Failure FarmClient::too_much(const char* what) const {
  return {kFailed,
          fmt::format("the coordinator at {} sends {} of more than half of the memory here, {}",
                      way_.address, what, core::format_bytes(options_.most_bytes))};
}

Outcome FarmClient::count_part(const google::protobuf::Message& part, uint64_t& bytes) const {
  bytes += part.SpaceUsedLong();
  if (bytes > options_.most_bytes) return too_much("a list");
  return std::nullopt;
}

Outcome FarmClient::get(uint64_t job, v1::GetJobResponse& response) {
  v1::GetJobRequest request;
  request.set_job(job);
  response.Clear();
  v1::GetJobResponse part;
  uint64_t bytes = 0;
  do {
    if (auto failure = call("Jobs/Get", request, part)) return failure;
    if (auto failure = count_part(part, bytes)) return failure;
    response.mutable_job()->Swap(part.mutable_job());
    response.mutable_frames()->MergeFrom(part.frames());
    if (part.frames_size() == 0) break;
    const int32_t last = part.frames().rbegin()->frame();
    if (request.has_after() && last <= request.after()) {
      return Failure{kFailed, "the coordinator lists frames whose numbers do not grow"};
    }
    request.set_after(last);
  } while (part.more());
  return std::nullopt;
}

Outcome FarmClient::watch(uint64_t job,
                          const std::function<bool(const v1::WatchEvent&)>& on_event) {
  v1::WatchRequest request;
  request.set_job(job);
  return stream<v1::WatchEvent>("Jobs/Watch", request, kAsLongAsItLives, on_event);
}

Outcome FarmClient::outputs(const v1::OutputsRequest& request,
                            const std::function<Outcome(const v1::OutputFile&)>& on_file) {
  Outcome stopped;
  return stream<v1::OutputFile>(
      "Jobs/Outputs", request, request.follow() ? kAsLongAsItLives : kLongCall,
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
  return stream<v1::Chunk>("Jobs/Fetch", request, transfer_time(size), on_chunk, stopped);
}

core::FilmLimits FarmClient::film_limits(const std::string& packed) const {
  core::FilmLimits limits;
  limits.max_bytes = options_.most_bytes - std::min<uint64_t>(options_.most_bytes, packed.size());
  return limits;
}

Outcome FarmClient::film(uint64_t job, int32_t frame, v1::FilmHeader& header, std::string& bytes,
                         const std::function<void(uint64_t)>& on_progress) {
  v1::FilmRequest request;
  request.set_job(job);
  request.set_frame(frame);
  Outcome stopped;
  return stream<v1::FilmPart>(
      "Jobs/Film", request, transfer_time(farm::kMaxResultBytes),
      [&](const v1::FilmPart& part) {
        if (part.has_header()) {  // the first message of each try
          header = part.header();
          bytes.clear();
          if (header.size() > options_.most_bytes) stopped = too_much("a film");
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
                         const std::function<bool(const v1::LogLine&)>& on_line) {
  return stream<v1::LogLine>(
      "Jobs/Logs", request, request.follow() ? kAsLongAsItLives : kLongCall,
      [&](const v1::LogLine& line) {
        request.set_after(line.number());  // after a break those told already do not come again
        return on_line(line);
      });
}

Outcome FarmClient::upload(const core::AssetRecord& file, std::istream& input, uint64_t offset,
                           const std::function<void(uint64_t)>& on_progress) {
  const auto digest = farm::digest_from_hex(file.sha256);
  if (!digest) return Failure{kFailed, digest.error().message};
  const Failure changed{kFailed, file.reference + " changed while it was being sent: submit again"};
  input.seekg(static_cast<std::streamoff>(offset));
  if (!input) return Failure{kFailed, file.reference + ": cannot be read"};

  grpc::ClientContext context;
  farm::prepare(context, token_, transfer_time(file.size));
  ByteCall call(channel(), context, "Assets/Upload");
  v1::UploadPart part;
  part.set_sha256(farm::to_wire(*digest));
  part.set_size(file.size);
  uint64_t sent = offset;
  do {
    std::string& data = *part.mutable_chunk()->mutable_data();
    data.resize(std::min(farm::kMaxChunkBytes, file.size - sent));
    input.read(data.data(), static_cast<std::streamsize>(data.size()));
    if (static_cast<size_t>(input.gcount()) != data.size()) {
      call.cancel();
      (void)call.finish();
      return changed;
    }
    part.mutable_chunk()->set_offset(sent);
    if (!call.write(part, false)) break;
    sent += data.size();
    on_progress(data.size());
    part.Clear();
  } while (sent < file.size);
  call.writes_done();
  v1::UploadResponse response;
  (void)call.read(response);
  const grpc::Status status = call.finish();
  if (status.ok()) {
    reached();
    channels_->answered();
    room_.reached();
    return std::nullopt;
  }
  Failure out = failure(status);
  if (status.error_code() == grpc::StatusCode::DATA_LOSS) out.message = changed.message;
  // The caller asks how far it came and goes on from there. What the coordinator said may be held
  // by a stream that it does not know to be broken yet: then everything has to come again.
  out.from_start = status.error_code() == grpc::StatusCode::OUT_OF_RANGE && offset > 0;
  out.again = wait_after(status);
  return out;
}

Outcome FarmClient::create_token(const v1::CreateTokenRequest& request,
                                 v1::CreateTokenResponse& response) {
  // A call of no effect first: a coordinator that has just gone is waited for.
  v1::WhoAmIResponse me;
  if (Outcome failed = call("Admin/WhoAmI", v1::WhoAmIRequest(), me)) return failed;
  grpc::ClientContext context;
  farm::prepare(context, token_, kShortCall);
  const grpc::Status status = call_once(channel(), context, "Admin/CreateToken", request, response);
  return status.ok() ? Outcome() : failure(status);
}

Outcome FarmClient::audit(int64_t since_ms,
                          const std::function<void(const v1::AuditEntry&)>& on_entry) {
  v1::AuditRequest request;
  request.set_since_ms(since_ms);
  return stream<v1::AuditEntry>("Admin/Audit", request, transfer_time(farm::kMaxResultBytes),
                                [&](const v1::AuditEntry& entry) {
                                  on_entry(entry);
                                  request.set_since_ms(entry.time_ms() + 1);
                                  return true;
                                });
}

Outcome FarmClient::workers(v1::WorkersResponse& response) {
  response.Clear();
  v1::WorkersRequest request;
  uint64_t bytes = 0;
  for (;;) {
    v1::WorkersResponse page;
    if (auto failure = call("Farm/Workers", request, page)) return failure;
    if (auto failure = count_part(page, bytes)) return failure;
    for (v1::Worker& worker : *page.mutable_workers()) *response.add_workers() = std::move(worker);
    if (page.workers().empty() || page.next_after() <= request.after()) break;
    request.set_after(page.next_after());
  }
  std::sort(response.mutable_workers()->begin(), response.mutable_workers()->end(),
            [](const v1::Worker& a, const v1::Worker& b) {
              return a.name() != b.name() ? a.name() < b.name() : a.id() < b.id();
            });
  return std::nullopt;
}

}  // namespace hyades::cli
