#include "coordinator/web/assets_api.h"

#include <algorithm>
#include <set>
#include <span>

#include "coordinator/services/upload_note.h"
#include "coordinator/web/handing.h"
#include "farm/content_store.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

constexpr size_t kMostAsked = 10'000;
constexpr size_t kMostOpen = 64;
constexpr std::chrono::seconds kOpenFor{60};

grpc::Status invalid(const std::string& message) {
  return {grpc::StatusCode::INVALID_ARGUMENT, message};
}

/// What a JSON object with a digest and a size means.
struct Wanted {
  std::string name;
  uint64_t size = 0;
};

std::optional<Wanted> read_wanted(const farm::Json& json) {
  if (!json.is_object() || !json.contains("sha256") || !json.contains("size")) return std::nullopt;
  const farm::Json& name = json["sha256"];
  const farm::Json& size = json["size"];
  if (!name.is_string() || !size.is_number_unsigned()) return std::nullopt;
  Wanted wanted{name.get<std::string>(), size.get<uint64_t>()};
  if (!farm::is_content_name(wanted.name)) return std::nullopt;
  return wanted;
}

}  // namespace

void AssetsApi::add_routes(Router& router) {
  router.add(
      "POST", "/api/v1/assets/missing", [this](const WebRequest& request, const Answer& answer) {
        answer_by(executors_.files, answer, [this, body = request.body] { return missing(body); });
      });
  router.add(
      "PUT", "/api/v1/assets/{sha256}", [this](const WebRequest& request, const Answer& answer) {
        const std::string& name = request.parameters.at("sha256");
        if (!farm::is_content_name(name)) {
          answer(error_reply(invalid("sha256: expected 64 hexadecimal digits in small letters")));
          return;
        }
        if (!request.query.contains("size")) {
          answer(error_reply(invalid("size: expected the size of the whole file")));
          return;
        }
        const auto size = query_number<uint64_t>(request, "size", 0, answer);
        if (!size) return;
        const auto offset = query_number<uint64_t>(request, "offset", 0, answer);
        if (!offset) return;
        answer_by(executors_.files, answer,
                  [this, caller = request.caller, name, whole = *size, from = *offset,
                   piece = request.body] { return take(caller, name, whole, from, piece); });
      });
}

WebReply AssetsApi::missing(const std::string& body) {
  const std::unique_lock alone(large_, std::try_to_lock);
  if (!alone) return error_reply(crowded());
  const auto json = farm::Json::parse(body, nullptr, false);
  if (!json.is_object() || !json.contains("files") || !json["files"].is_array()) {
    return error_reply(invalid("expected {\"files\": [{\"sha256\": ..., \"size\": ...}, ...]}"));
  }
  if (json["files"].size() > kMostAsked) {
    return error_reply(invalid("at most 10,000 files at a time"));
  }
  farm::Json missing = farm::Json::array();
  std::set<std::string> seen;
  for (const farm::Json& file : json["files"]) {
    const auto wanted = read_wanted(file);
    if (!wanted) return error_reply(invalid("files: expected sha256 and size of each"));
    if (!seen.insert(wanted->name).second) continue;
    if (controller_.assets().contains(wanted->name, wanted->size)) {
      controller_.assets().touch(wanted->name);
      continue;
    }
    const uint64_t begun = std::min(controller_.assets().begun(wanted->name), wanted->size);
    missing.push_back({{"sha256", wanted->name}, {"offset", begun}});
  }
  return json_reply({{"missing", std::move(missing)}});
}

WebReply AssetsApi::take(const Caller& caller, const std::string& name, uint64_t size,
                         uint64_t offset, const std::string& piece) {
  if (controller_.assets().contains(name, size)) {
    return json_reply({{"offset", size}, {"complete", true}});
  }
  if (controller_.disk().is_full()) {
    // What has come stays for a later upload to go on with.
    if (const grpc::Status room = controller_.disk().admit(0); !room.ok()) return error_reply(room);
  }
  {
    const std::lock_guard lock(mutex_);
    if (!busy_.insert(name).second) {
      return error_reply(farm::retry_later(grpc::StatusCode::ABORTED,
                                           "another piece of this file is being written",
                                           std::chrono::milliseconds(500)));
    }
  }
  auto writer = take_writer(caller, name, size);
  WebReply reply = writer.ok() ? append(*writer.writer, offset, piece) : error_reply(writer.status);
  if (writer.ok() && writer.writer->offset() < size) put_back(name, std::move(writer.writer));
  done_with(name);
  return reply;
}

void AssetsApi::done_with(const std::string& name) {
  const std::lock_guard lock(mutex_);
  busy_.erase(name);
}

void AssetsApi::sweep() {
  const std::lock_guard lock(mutex_);
  let_go_of_old();
}

WebReply AssetsApi::append(farm::ContentWriter& writer, uint64_t offset, const std::string& piece) {
  const uint64_t size = writer.size();
  if (offset > writer.offset()) {
    return error_reply({grpc::StatusCode::OUT_OF_RANGE,
                        fmt::format("bytes from {} on are missing", writer.offset())});
  }
  if (offset > size || piece.size() > size - offset) {
    return error_reply(invalid(fmt::format("more than the {} bytes that were announced", size)));
  }
  // What is here already comes again where the client did not know of it.
  const auto bytes = std::as_bytes(std::span(piece));
  const uint64_t known = std::min<uint64_t>(writer.offset() - offset, bytes.size());
  if (auto written = writer.append(bytes.subspan(known)); !written) {
    return error_reply(farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                                         written.error().message, std::chrono::seconds(10)));
  }
  if (writer.offset() < size) {
    return json_reply({{"offset", writer.offset()}, {"complete", false}});
  }
  if (auto whole = writer.commit(); !whole) {
    if (const grpc::Status room = controller_.disk().admit(0); !room.ok()) return error_reply(room);
    return error_reply({grpc::StatusCode::DATA_LOSS, whole.error().message});
  }
  return json_reply({{"offset", size}, {"complete", true}});
}

AssetsApi::Taken AssetsApi::take_writer(const Caller& caller, const std::string& name,
                                        uint64_t size) {
  {
    const std::lock_guard lock(mutex_);
    let_go_of_old();
    const auto open = open_.find(name);
    if (open != open_.end() && open->second.writer->size() == size) {
      Taken taken{std::move(open->second.writer), grpc::Status::OK};
      open_.erase(open);
      return taken;
    }
  }
  const uint64_t begun = std::min(controller_.assets().begun(name), size);
  if (grpc::Status room = controller_.disk().admit(size - begun); !room.ok())
    return {nullptr, room};
  auto writer = controller_.assets().write(name, size);
  if (!writer) {
    return {nullptr, farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED, writer.error().message,
                                       std::chrono::seconds(10))};
  }
  note_upload(audit_, caller, name, size, writer->offset());
  return {std::make_unique<farm::ContentWriter>(std::move(*writer)), grpc::Status::OK};
}

void AssetsApi::put_back(const std::string& name, std::unique_ptr<farm::ContentWriter> writer) {
  const std::lock_guard lock(mutex_);
  // Without its writer the next piece reads again what is there.
  if (open_.size() < kMostOpen) {
    open_[name] = {std::move(writer), std::chrono::steady_clock::now()};
  }
}

/// With the lock.
void AssetsApi::let_go_of_old() {
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(open_, [&](const auto& open) { return now - open.second.used > kOpenFor; });
}

}  // namespace hyades::coordinator
