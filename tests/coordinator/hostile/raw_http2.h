#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hyades::test {

/// Just enough HTTP/2 (RFC 9113) to be a bad client: one that announces what it does not send,
/// packs what it sends, never reads, or does nothing at all. One thread at a time.
class RawHttp2 {
 public:
  /// Connects to "127.0.0.1:PORT"; `talk`: sends the preface, otherwise not one byte. `from`: as
  /// which address of this machine, 127.0.0.2, say, which counts as somebody else.
  explicit RawHttp2(const std::string& address, bool talk = true,
                    const std::string& from = "127.0.0.1");
  ~RawHttp2();
  RawHttp2(const RawHttp2&) = delete;
  RawHttp2& operator=(const RawHttp2&) = delete;

  bool connected() const { return connected_; }

  /// Whether the other side says its first word within `milliseconds`. Before it, who has shown no
  /// token yet sends little.
  bool greeted(int milliseconds);

  /// Lets the other side send 2 GiB without being asked for more.
  void open_windows();

  /// Begins a gRPC call; 1, 3, 5, ...
  uint32_t call(const std::string& path,
                const std::vector<std::pair<std::string, std::string>>& headers = {});

  /// Begins a call whose headers do not end, up to so many bytes; how many have gone when the
  /// other side has ended the connection.
  uint64_t endless_headers(uint64_t most);
  /// Begins calls and breaks them off at once, up to so many bytes; the same.
  uint64_t broken_calls(const std::string& path, uint64_t most,
                        const std::vector<std::pair<std::string, std::string>>& headers = {});

  /// Sends bytes of the call's messages as fast as the other side wants them; how many have gone
  /// when it has had no wish for more for half a second, or the call was over.
  uint64_t send(uint32_t call, std::string_view bytes);
  /// The end of what the caller sends.
  void finish(uint32_t call);

  /// Whether the other side has ended the call; waits for it up to `milliseconds`.
  bool ended(uint32_t call, int milliseconds);

  /// Whether the other side has ended the connection; waits for it up to `milliseconds`.
  bool closed(int milliseconds);

  /// A message's five bytes of gRPC.
  static std::string head(uint32_t length, bool packed = false);

 private:
  void write(std::string_view bytes);
  void frame(uint8_t type, uint8_t flags, uint32_t stream, std::string_view payload);
  /// Takes in what has come, after waiting for something up to `milliseconds`.
  void read(int milliseconds);
  void take(uint8_t type, uint8_t flags, uint32_t stream, std::string_view payload);

  int socket_ = -1;
  bool connected_ = false;
  bool greeted_ = false;
  uint32_t next_ = 1;
  std::string incoming_;
  int64_t window_ = 65'535;
  int64_t initial_window_ = 65'535;
  std::map<uint32_t, int64_t> windows_;
  std::map<uint32_t, bool> ended_;
};

}  // namespace hyades::test
