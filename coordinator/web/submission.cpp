#include "coordinator/web/submission.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "core/base/text.h"
#include "farm/json_form.h"
#include "farm/wire.h"

namespace hyades::coordinator {
namespace {

using farm::Json;

/// Reads the fields of one object; the first that is wrong is remembered.
class Fields {
 public:
  Fields(const Json& json, std::string where) : json_(json), where_(std::move(where)) {}

  std::string text(const char* name, bool needed) {
    const Json* value = find(name, needed);
    if (value == nullptr) return {};
    if (value->is_string()) return value->get<std::string>();
    wrong(name, "a text");
    return {};
  }

  template <class Number>
  std::optional<Number> number(const char* name, bool needed) {
    const Json* value = find(name, needed);
    if (value == nullptr) return std::nullopt;
    if (value->is_number_integer()) {
      // Within int64_t for what is signed or small, and uint64_t for the rest.
      if (value->is_number_unsigned()) {
        const auto got = value->get<uint64_t>();
        if (got <= static_cast<uint64_t>(std::numeric_limits<Number>::max())) {
          return static_cast<Number>(got);
        }
      } else if (std::is_signed_v<Number>) {
        const auto got = value->get<int64_t>();
        if (got >= static_cast<int64_t>(std::numeric_limits<Number>::min())) {
          return static_cast<Number>(got);
        }
      }
    }
    wrong(name, std::is_signed_v<Number> ? "a whole number" : "a whole number, 0 or more");
    return std::nullopt;
  }

  const Json* array(const char* name, bool needed) {
    const Json* value = find(name, needed);
    if (value == nullptr || value->is_array()) return value;
    wrong(name, "a list");
    return nullptr;
  }

  /// Complains of what nobody has asked for.
  void finish() {
    for (const auto& [name, value] : json_.items()) {
      if (std::find(asked_.begin(), asked_.end(), name) != asked_.end() || error_) continue;
      error_ = core::Error{
          fmt::format("{}{}: unknown{}", where_, name, core::did_you_mean(name, asked_))};
    }
  }

  void wrong(const std::string& name, const std::string& expected) {
    if (!error_) error_ = core::Error{fmt::format("{}{}: expected {}", where_, name, expected)};
  }
  const std::optional<core::Error>& error() const { return error_; }

 private:
  const Json* find(const char* name, bool needed) {
    asked_.emplace_back(name);
    const auto found = json_.find(name);
    if (found != json_.end() && !found->is_null()) return &*found;
    if (needed) wrong(name, "one");
    return nullptr;
  }

  const Json& json_;
  std::string where_;
  std::vector<std::string> asked_;
  std::optional<core::Error> error_;
};

core::Status read_files(const Json& files, v1::JobSpec& spec) {
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string where = fmt::format("files[{}].", i);
    if (!files[i].is_object()) return core::Error{where + ": expected path, sha256 and size"};
    Fields fields(files[i], where);
    v1::JobFile& file = *spec.add_files();
    file.set_path(fields.text("path", true));
    const auto digest = farm::digest_from_hex(fields.text("sha256", true));
    if (digest) {
      file.set_sha256(farm::to_wire(*digest));
    } else {
      fields.wrong("sha256", "64 hexadecimal digits");
    }
    file.set_size(fields.number<uint64_t>("size", true).value_or(0));
    fields.finish();
    if (fields.error()) return *fields.error();
  }
  return {};
}

core::Status read_frames(const Json& frames, v1::JobSpec& spec) {
  for (size_t i = 0; i < frames.size(); ++i) {
    const std::string where = fmt::format("frames[{}].", i);
    if (!frames[i].is_object()) return core::Error{where + ": expected first and last"};
    Fields fields(frames[i], where);
    v1::FrameRange& range = *spec.add_frames();
    range.set_first(fields.number<int32_t>("first", true).value_or(0));
    range.set_last(fields.number<int32_t>("last", true).value_or(0));
    range.set_step(fields.number<int32_t>("step", false).value_or(0));
    fields.finish();
    if (fields.error()) return *fields.error();
  }
  return {};
}

}  // namespace

core::Result<v1::SubmitRequest> read_submission(const std::string& body) {
  const Json json = Json::parse(body, nullptr, false);
  if (!json.is_object()) return core::Error{"expected a JSON object: the submission"};
  Fields fields(json, "");
  v1::SubmitRequest request;
  v1::JobSpec& spec = *request.mutable_spec();
  spec.set_name(fields.text("name", true));
  spec.set_document(fields.text("document", true));
  spec.set_samples(fields.number<uint32_t>("samples", false).value_or(0));
  if (const Json* files = fields.array("files", true)) {
    if (core::Status read = read_files(*files, spec); !read) return read.error();
  }
  if (const Json* frames = fields.array("frames", false)) {
    if (core::Status read = read_frames(*frames, spec); !read) return read.error();
  }
  request.set_owner(fields.text("owner", false));
  request.set_priority(fields.number<int32_t>("priority", false).value_or(0));
  request.set_max_workers(fields.number<uint32_t>("max_workers", false).value_or(0));
  request.set_idempotency_key(fields.text("idempotency_key", false));
  if (const Json* tags = fields.array("tags", false)) {
    for (const Json& tag : *tags) {
      if (tag.is_string()) {
        request.add_tags(tag.get<std::string>());
      } else {
        fields.wrong("tags", "texts");
      }
    }
  }
  request.set_memory_bytes(fields.number<uint64_t>("memory_bytes", false).value_or(0));
  request.set_max_attempts(fields.number<uint32_t>("max_attempts", false).value_or(0));
  const std::string order = fields.text("frame_order", false);
  if (order == "progressive") {
    request.set_frame_order(v1::FRAME_ORDER_PROGRESSIVE);
  } else if (order == "sequential") {
    request.set_frame_order(v1::FRAME_ORDER_SEQUENTIAL);
  } else if (!order.empty()) {
    fields.wrong("frame_order", "sequential or progressive");
  }
  fields.finish();
  if (fields.error()) return *fields.error();
  return request;
}

}  // namespace hyades::coordinator
