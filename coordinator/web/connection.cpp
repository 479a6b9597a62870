#include "coordinator/web/connection.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <boost/asio/ssl/context.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>

#include "coordinator/access/address.h"
#include "coordinator/access/caller.h"
#include "coordinator/meters/meters.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/message_heads.h"
#include "coordinator/web/request_target.h"
#include "farm/byte_budget.h"
#include "farm/wire.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using ErrorCode = beast::error_code;
using Plain = beast::tcp_stream;
using Tls = beast::ssl_stream<beast::tcp_stream>;

/// A year without plain text to this host, for browsers (RFC 6797).
constexpr const char* kOnlyByTls = "max-age=31536000";
/// Between requests.
constexpr std::chrono::seconds kIdle{75};
/// For a handshake, until the first request begins, and for a request's head from its first byte.
constexpr std::chrono::seconds kBegin{10};
/// For a request's body: a little, and what its bytes take over a slow line (64 KiB/s).
constexpr std::chrono::seconds kReceive{20};
constexpr uint64_t kSlowLine = 64U << 10U;
constexpr uint32_t kMostHeaderBytes = 16U << 10U;
/// Bodies that always have room: each connection has one, and of those there are not many.
constexpr uint64_t kSmallBody = farm::kMaxRequestBytes;
constexpr uint64_t kSmallAnswer = uint64_t{4} << 10U;
/// Of what has come and is not parsed yet. Beast waits for the whole of a chunk's head, and of the
/// fields behind the last chunk, however long they are.
constexpr size_t kMostUnparsed = size_t{64} << 10U;
constexpr size_t kPiece = size_t{1} << 20U;
/// How soon it is looked again whether a piece has room.
constexpr std::chrono::milliseconds kRoomAgain{250};
/// What may wait for a reader of what happens before it is broken off.
constexpr size_t kMostWaitingBytes = size_t{8} << 20U;
constexpr std::chrono::seconds kHeartbeat{15};
/// One behind the other, without waiting for the answers, of who has shown no token. Browsers and
/// proxies send none so; who means ill has each of a crowd's connections ask hundreds of times.
constexpr int kMostAhead = 8;
/// Of server-sent events: nothing to who reads them.
constexpr const char* kComment = ":\n\n";
/// How soon it is looked again whether there is news.
constexpr std::chrono::milliseconds kNewsAgain{500};
constexpr std::chrono::seconds kFarewell{10};
/// Read and thrown away after a refusal, so that the other side reads it before it hears that
/// nobody listens any more.
constexpr size_t kMostThrownAway = size_t{32} << 20U;

Plain& tcp(Plain& stream) { return stream; }
Plain& tcp(Tls& stream) { return beast::get_lowest_layer(stream); }

template <class Stream>
class ConnectionOver final : public Connection,
                             public std::enable_shared_from_this<ConnectionOver<Stream>> {
 public:
  template <class... Arguments>
  ConnectionOver(ConnectionWorld& world, std::string address, Neighbour owner,
                 std::shared_ptr<asio::ssl::context> tls, Arguments&&... stream)
      : world_(world),
        address_(std::move(address)),
        owner_(std::move(owner)),
        tls_(std::move(tls)),
        stream_(std::forward<Arguments>(stream)...),
        timer_(stream_.get_executor()) {}

  void begin() override {
    world_.open.insert(self());
    world_.meters.http_connections().Increment();
    place_ = world_.count.enter(owner_);
    if constexpr (std::is_same_v<Stream, Tls>) {
      tcp(stream_).expires_after(kBegin);
      stream_.async_handshake(asio::ssl::stream_base::server, [me = self()](ErrorCode error) {
        if (error) return me->close();
        me->wait_for_request(kBegin);
      });
    } else {
      wait_for_request(kBegin);
    }
  }

  void push(std::shared_ptr<const std::string> bytes) override {
    world_.io->post([weak = weak_from_this_(), bytes = std::move(bytes)]() mutable {
      if (const auto me = weak.lock()) me->enqueue(std::move(bytes));
    });
  }

  void end() override {
    world_.io->post([weak = weak_from_this_()] {
      if (const auto me = weak.lock()) me->end_live();
    });
  }

  void cut_off() override {
    world_.io->post([weak = weak_from_this_()] {
      if (const auto me = weak.lock()) me->close();
    });
  }

 private:
  std::shared_ptr<ConnectionOver> self() { return this->shared_from_this(); }
  std::weak_ptr<ConnectionOver> weak_from_this_() { return this->weak_from_this(); }

  /// What came with the request before may have begun one.
  void wait_for_request(std::chrono::seconds patience) {
    if (buffer_.size() > 0) {
      ++ahead_;
      return read();
    }
    ahead_ = 0;
    tcp(stream_).expires_after(patience);
    stream_.async_read_some(buffer_.prepare(kMostHeaderBytes),
                            [me = self()](ErrorCode error, size_t count) {
                              if (error == asio::error::eof) return me->shut_down();
                              if (error) return me->close();
                              me->buffer_.commit(count);
                              me->read();
                            });
  }

  void read() {
    parser_.emplace();
    parser_->header_limit(kMostHeaderBytes);
    // It is set once the header has been looked at. (None at all refuses every body in Boost 1.74.)
    parser_->body_limit(std::numeric_limits<uint64_t>::max());
    tcp(stream_).expires_after(kBegin);
    http::async_read_header(stream_, buffer_, *parser_,
                            [me = self()](ErrorCode error, size_t) { me->on_header(error); });
  }

  void on_header(ErrorCode error) {
    if (error == http::error::end_of_stream) return shut_down();
    if (error) return refuse(error);
    const auto& header = parser_->get();
    keep_alive_ = header.keep_alive();
    version_ = header.version();
    head_only_ = header.method() == http::verb::head;
    request_ = request_of(header);
    known_ = request_.header("if-none-match");
    if (const grpc::Status framed = check_framing(header); !framed.ok()) {
      return send_away(error_reply(framed));
    }
    auto target = parse_target(request_.target);
    if (!target) {
      return send_away(
          error_reply({grpc::StatusCode::INVALID_ARGUMENT, "the address makes no sense"}));
    }
    request_.path = std::move(target->path);
    request_.query = std::move(target->query);
    request_.address = address_;
    const ConnectionWorld::Admitted admitted =
        world_.admit(request_, [this] { return own_end(tcp(stream_).socket().native_handle()); });
    if (admitted.refusal) return send_away(*admitted.refusal);
    caller_ = request_.caller;
    const bool stranger = caller_.role == v1::ROLE_UNSPECIFIED;
    if (!stranger) world_.count.know(owner_, caller_.token_id, std::chrono::steady_clock::now());
    if (world_.one_request || (stranger && ahead_ >= kMostAhead)) keep_alive_ = false;
    take_body(admitted.most_bytes);
  }

  void take_body(uint64_t most_bytes) {
    const auto length = parser_->content_length();
    if (length && *length > most_bytes) return refuse(http::error::body_limit);
    // Even without a body there would be chunks' heads and fields to wait for.
    if (parser_->chunked() && most_bytes == 0) return refuse(http::error::body_limit);
    const uint64_t asked = length ? *length : parser_->chunked() ? most_bytes : 0;
    body_share_.emplace(world_.bodies, owner_of(caller_));
    if (!body_share_->try_hold(asked > kSmallBody ? asked : 0)) {
      return send_away(error_reply(farm::retry_later(grpc::StatusCode::RESOURCE_EXHAUSTED,
                                                     "the coordinator takes in as much as it may",
                                                     std::chrono::seconds(1))));
    }
    parser_->body_limit(most_bytes);
    tcp(stream_).expires_after(kReceive + std::chrono::seconds(static_cast<int64_t>(
                                              length.value_or(most_bytes) / kSlowLine)));
    if (!beast::iequals(parser_->get()[http::field::expect], "100-continue")) return read_body();
    static const std::string kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    asio::async_write(stream_, asio::buffer(kContinue), [me = self()](ErrorCode bad, size_t) {
      if (bad) return me->close();
      me->read_body();
    });
  }

  void read_body() {
    http::async_read(stream_, buffer_, *parser_, [me = self()](ErrorCode error, size_t) {
      if (error) return me->refuse(error);
      me->on_request();
    });
  }

  /// What is no HTTP, or too much of it, is told so where that can be done.
  void refuse(ErrorCode error) {
    if (error.category() != http::make_error_code(http::error::bad_method).category() ||
        error == http::error::partial_message) {
      return close();
    }
    head_only_ = false;
    const bool long_head = error == http::error::header_limit;
    const bool large =
        long_head || error == http::error::body_limit || error == http::error::buffer_overflow;
    WebReply reply = error_reply(
        {grpc::StatusCode::INVALID_ARGUMENT, large ? "the request is too large" : error.message()});
    if (large) reply.status = long_head ? 431 : 413;
    send_away(std::move(reply));
  }

  /// The rest of the request is not read, so nothing can follow it.
  void send_away(WebReply reply) {
    keep_alive_ = false;
    throw_away_ = true;
    send(std::move(reply));
  }

  void on_request() {
    request_.body = std::move(parser_->release().body());
    // However long the answer takes.
    tcp(stream_).expires_never();
    world_.serve(std::move(request_), [io = world_.io, weak = weak_from_this_()](WebReply reply) {
      io->post([weak, reply = std::move(reply)]() mutable {
        if (const auto me = weak.lock()) me->send(std::move(reply));
      });
    });
  }

  void send(WebReply reply) {
    reply_ = std::move(reply);
    leave_out_known(reply_, known_);
    count_answer();
    if (reply_.topic || reply_.source) {
      grpc::Status refused;
      entry_ = world_.entry(caller_, refused);
      if (!refused.ok()) reply_ = error_reply(refused);
    }
    if (reply_.topic || reply_.source) {
      // Its token may be revoked meanwhile.
      visit_ =
          world_.visit(caller_, [io = world_.io, weak = weak_from_this_()](const grpc::Status&) {
            io->post([weak] {
              if (const auto me = weak.lock()) me->close();
            });
          });
    }
    header_ = head_of(reply_, version_, keep_alive_);
    if constexpr (std::is_same_v<Stream, Tls>) {
      header_->set(http::field::strict_transport_security, kOnlyByTls);
    }
    serializer_.emplace(*header_);
    tcp(stream_).expires_after(world_.send_patience);
    http::async_write_header(stream_, *serializer_, [me = self()](ErrorCode error, size_t) {
      if (error) return me->close();
      me->send_body();
    });
  }

  /// What others hold, too, is counted where it is made.
  void count_answer() {
    uint64_t bytes = reply_.source ? reply_.source->bytes_kept() : 0;
    if (reply_.text && !reply_.is_counted && reply_.text.use_count() == 1 &&
        reply_.text->size() > kSmallAnswer) {
      bytes = reply_.text->size();
    }
    answer_share_.emplace(world_.answers, owner_of(caller_));
    if (!answer_share_->try_hold(bytes)) reply_ = error_reply(too_much_unread());
  }

  void send_body() {
    if (head_only_) return sent();
    if (reply_.topic) return go_live();
    if (reply_.source) {
      // What is waited for without an end has no time to come in.
      tcp(stream_).expires_never();
      if (reply_.source->goes_on()) watch_for_end();
      return next_piece();
    }
    if (!reply_.text) return sent();
    send_text(reply_.text, 0, [this] { sent(); });
  }

  /// In pieces, so that each has its time.
  void send_text(std::shared_ptr<const std::string> text, size_t from, std::function<void()> then) {
    if (from >= text->size()) return then();
    const size_t count = std::min(kPiece, text->size() - from);
    tcp(stream_).expires_after(world_.send_patience);
    const auto piece = asio::buffer(text->data() + from, count);
    world_.meters.http_bytes(count);
    asio::async_write(
        stream_, piece,
        [me = self(), text, from, count, then = std::move(then)](ErrorCode error, size_t) mutable {
          if (error) return me->close();
          me->send_text(std::move(text), from + count, std::move(then));
        });
  }

  void next_piece() {
    tcp(stream_).expires_never();
    if (!answer_share_) return close();  // it was closed meanwhile
    const BodySource& source = *reply_.source;
    if (!answer_share_->try_hold(source.bytes_needed() + source.bytes_kept())) {
      return wait_for_room();
    }
    const bool taken = world_.files.submit(
        [io = world_.io, weak = weak_from_this_(), source = reply_.source] {
          std::optional<std::string> piece = source->next();
          io->post([weak, piece = std::move(piece)]() mutable {
            if (const auto me = weak.lock()) me->send_piece(std::move(piece));
          });
        },
        owner_of(caller_).name);
    if (!taken) close();
  }

  /// Others read slowly what is counted for the same owner; who reads nothing goes in time.
  void wait_for_room() {
    answer_share_->hold(reply_.source->bytes_kept());
    timer_.expires_after(kRoomAgain);
    timer_.async_wait([weak = weak_from_this_()](ErrorCode error) {
      const auto me = weak.lock();
      if (!error && me && me->reply_.source) me->next_piece();
    });
  }

  /// In between a comment tells the other side that there is somebody, and us whether he is there.
  void wait_for_news() {
    answer_share_->hold(reply_.source->bytes_kept());
    timer_.expires_after(kNewsAgain);
    timer_.async_wait([weak = weak_from_this_()](ErrorCode error) {
      const auto me = weak.lock();
      if (error || !me || !me->answer_share_) return;
      me->silent_ += kNewsAgain;
      if (me->reply_.source->has_news()) return me->next_piece();
      if (me->silent_ < kHeartbeat) return me->wait_for_news();
      me->piece_ = kComment;
      me->write_piece(asio::buffer(me->piece_), false);
    });
  }

  void send_piece(std::optional<std::string> piece) {
    // Half of a body is told from the whole by the connection's end.
    if (!piece || !answer_share_) return close();
    const bool chunked = header_->chunked();
    const bool last = piece->empty();
    if (last && reply_.source->goes_on()) return wait_for_news();
    if (last && !chunked) return sent();
    piece_ = std::move(*piece);
    answer_share_->hold(piece_.size() + reply_.source->bytes_kept());
    if (!chunked) {
      write_piece(asio::buffer(piece_), false);
    } else if (last) {
      write_piece(http::make_chunk_last(), true);
    } else {
      write_piece(http::make_chunk(asio::buffer(piece_)), false);
    }
  }

  template <class Buffers>
  void write_piece(const Buffers& buffers, bool last) {
    silent_ = {};
    world_.meters.http_bytes(piece_.size());
    tcp(stream_).expires_after(world_.send_patience);
    asio::async_write(stream_, buffers, [me = self(), last](ErrorCode error, size_t) {
      if (error) return me->close();
      if (last) return me->sent();
      me->next_piece();
    });
  }

  void sent() {
    give_back();
    visit_.reset();
    entry_.reset();
    reply_ = {};
    serializer_.reset();
    header_.reset();
    if (!keep_alive_) return shut_down();
    wait_for_request(kIdle);
  }

  // What happens, as it happens.

  void go_live() {
    live_ = true;
    tcp(stream_).expires_never();
    reply_.topic->join(weak_from_this_());
    watch_for_end();
    beat();
  }

  /// Nothing is expected from the other side but its end.
  void watch_for_end() {
    stream_.async_read_some(asio::buffer(&unexpected_, 1), [me = self()](ErrorCode error, size_t) {
      if (error) return me->close();
      me->watch_for_end();
    });
  }

  void beat() {
    timer_.expires_after(kHeartbeat);
    timer_.async_wait([weak = weak_from_this_()](ErrorCode error) {
      const auto me = weak.lock();
      if (error || !me || !me->live_) return;
      me->enqueue(std::make_shared<const std::string>(kComment));
      me->beat();
    });
  }

  void enqueue(std::shared_ptr<const std::string> bytes) {
    if (!live_ || ending_) return;
    waiting_.push_back(std::move(bytes));
    if (waiting_.size() == 1) return send_waiting();
    // What is on its way may be as large as it is.
    waiting_bytes_ += waiting_.back()->size();
    if (waiting_bytes_ > kMostWaitingBytes) close();
  }

  void send_waiting() {
    send_text(waiting_.front(), 0, [this] {
      if (!live_) return;
      waiting_.pop_front();
      if (!waiting_.empty()) {
        waiting_bytes_ -= waiting_.front()->size();
        return send_waiting();
      }
      tcp(stream_).expires_never();
      if (ending_) shut_down();
    });
  }

  void end_live() {
    ending_ = true;
    if (live_ && waiting_.empty()) shut_down();
  }

  void shut_down() {
    live_ = false;
    give_back();
    timer_.expires_after(kFarewell);
    timer_.async_wait([weak = weak_from_this_()](ErrorCode error) {
      const auto me = weak.lock();
      if (!error && me) me->close();
    });
    if constexpr (std::is_same_v<Stream, Tls>) {
      stream_.async_shutdown([me = self()](ErrorCode) { me->close(); });
    } else {
      ErrorCode ignored;
      tcp(stream_).socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
      if (!throw_away_) return close();
      tcp(stream_).expires_after(kFarewell);
      thrown_away_.resize(kMostHeaderBytes);
      throw_more_away(0);
    }
  }

  void throw_more_away(size_t so_far) {
    stream_.async_read_some(asio::buffer(thrown_away_),
                            [me = self(), so_far](ErrorCode error, size_t count) {
                              if (error || so_far > kMostThrownAway) return me->close();
                              me->throw_more_away(so_far + count);
                            });
  }

  void give_back() {
    body_share_.reset();
    answer_share_.reset();
  }

  void close() {
    live_ = false;
    give_back();
    visit_.reset();
    entry_.reset();
    timer_.cancel();
    ErrorCode ignored;
    tcp(stream_).socket().close(ignored);
    if (world_.open.erase(self()) == 0) return;
    world_.meters.http_connections().Decrement();
    world_.count.leave(place_);
  }

  ConnectionWorld& world_;
  const std::string address_;  ///< of the other side, as address_text() has it
  const Neighbour owner_;
  ConnectionCount::Place place_;                   ///< whom it is counted for
  const std::shared_ptr<asio::ssl::context> tls_;  ///< outlives the stream
  Stream stream_;
  beast::flat_buffer buffer_{kMostUnparsed};
  std::optional<http::request_parser<http::string_body>> parser_;
  WebRequest request_;
  Caller caller_;  ///< of the request in work
  std::unique_ptr<Visit> visit_;
  std::unique_ptr<OwnerConnections::Entry> entry_;       ///< while its answer takes its time
  std::optional<farm::ByteBudget::Share> body_share_;    ///< of its body
  std::optional<farm::ByteBudget::Share> answer_share_;  ///< of what answers it
  unsigned version_ = 11;
  bool keep_alive_ = false;
  int ahead_ = 0;  ///< requests that were there before the one before them was answered, in a row
  bool head_only_ = false;
  std::string known_;  ///< If-None-Match
  WebReply reply_;
  std::optional<ReplyHead> header_;
  std::optional<http::response_serializer<http::empty_body>> serializer_;
  std::string piece_;
  std::chrono::milliseconds silent_{0};  ///< since something was sent
  asio::steady_timer timer_;  ///< for heartbeats, for room, for the other side's farewell
  bool live_ = false;
  bool ending_ = false;  ///< once all that waits is sent
  char unexpected_ = 0;
  bool throw_away_ = false;  ///< something of the request was not read
  std::vector<char> thrown_away_;
  std::deque<std::shared_ptr<const std::string>> waiting_;
  size_t waiting_bytes_ = 0;
};

}  // namespace

std::shared_ptr<Connection> make_connection(asio::ip::tcp::socket socket, std::string address,
                                            Neighbour owner,
                                            const std::shared_ptr<asio::ssl::context>& tls,
                                            ConnectionWorld& world) {
  if (tls) {
    return std::make_shared<ConnectionOver<Tls>>(world, std::move(address), std::move(owner), tls,
                                                 std::move(socket), *tls);
  }
  return std::make_shared<ConnectionOver<Plain>>(world, std::move(address), std::move(owner), tls,
                                                 std::move(socket));
}

}  // namespace hyades::coordinator
