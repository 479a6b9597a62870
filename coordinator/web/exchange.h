#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"
#include "farm/json_form.h"

namespace hyades::coordinator {

/// A request as handlers see it, whatever connection it came by.
struct WebRequest {
  std::string method;                             ///< GET, POST, PUT, DELETE (HEAD comes as GET)
  std::string target;                             ///< path and query as they came
  std::vector<std::string> path;                  ///< decoded, without the slashes
  std::map<std::string, std::string> query;       ///< decoded; of a name given twice the last one
  std::map<std::string, std::string> parameters;  ///< what the route's {names} stand for
  std::map<std::string, std::string> headers;     ///< names in small letters
  std::string body;
  std::string address;  ///< where it comes from
  Caller caller;        ///< who asks, once that is known

  /// The header, or an empty text.
  const std::string& header(const std::string& name) const;
};

/// Bytes that are not all there at once: a file, an archive in the making.
class BodySource {
 public:
  /// A piece has about as many bytes at most. Each waits in memory until the client reads it, and
  /// many clients may be slow.
  static constexpr size_t kPieceBytes = size_t{64} << 10U;

  virtual ~BodySource() = default;
  /// The next bytes, which may be read from the disk: never called by the network's thread, never
  /// twice at once. Empty: that was all. Nothing: they cannot be read, and the connection is broken
  /// off, so that nobody takes half of it for the whole.
  virtual std::optional<std::string> next() = 0;
  /// How many bytes all together, where that is known.
  virtual std::optional<uint64_t> size() const = 0;
  /// What it keeps in memory besides a piece [bytes].
  virtual uint64_t bytes_kept() const { return 0; }
  /// What the next piece takes, with what is read for it [bytes].
  virtual uint64_t bytes_needed() const { return kPieceBytes; }
  /// An empty piece is no end: there is one again when has_news(), which any thread may ask.
  virtual bool goes_on() const { return false; }
  virtual bool has_news() const { return false; }
};

/// Somebody who reads what happens, as it happens.
class LiveReader {
 public:
  virtual ~LiveReader() = default;
  /// Bytes to send; any thread. A reader that is far behind is broken off.
  virtual void push(std::shared_ptr<const std::string> bytes) = 0;
  /// Nothing more will come.
  virtual void end() = 0;
  /// The reader is broken off, whatever he has not read.
  virtual void cut_off() = 0;
};

/// Something that happens, told to those who have joined.
class LiveTopic {
 public:
  virtual ~LiveTopic() = default;
  /// A reader that is gone is dropped with the next thing that happens.
  virtual void join(std::weak_ptr<LiveReader> reader) = 0;
};

/// What a request is answered with, whatever connection it goes by: a status, headers, and a body
/// that comes from one of three places, or none.
struct WebReply {
  unsigned status = 200;
  std::string type = "application/json; charset=utf-8";
  std::vector<std::pair<std::string, std::string>> headers;
  std::shared_ptr<const std::string> text;  ///< the whole body, or
  bool is_counted = false;                  ///< who made `text` counts it for as long as it is held
  std::shared_ptr<BodySource> source;       ///< where it comes from, or
  std::shared_ptr<LiveTopic> topic;         ///< what it tells of until the reader goes
};

/// Where the reply goes: called once, by any thread. Where the connection is gone nothing happens.
using Answer = std::function<void(WebReply)>;

/// 200 with JSON.
WebReply json_reply(const farm::Json& json);
/// 200 with a text of this media type.
WebReply text_reply(std::string text, const char* type);
/// `status` without a body: 204, say.
WebReply empty_reply(unsigned status);
/// What went wrong, as openapi.yaml's Error; the HTTP status follows from the code.
WebReply error_reply(const grpc::Status& status);

}  // namespace hyades::coordinator
