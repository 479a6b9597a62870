#pragma once

#include <map>
#include <string>
#include <vector>

namespace hyades::coordinator {

/// A person's browser, as far as tests need one: one request a connection, over plain text on this
/// machine.
class HttpClient {
 public:
  /// `url`: "http://127.0.0.1:PORT".
  explicit HttpClient(const std::string& url);

  struct Response {
    int status = 0;                              ///< 0: the connection was broken off before
    std::map<std::string, std::string> headers;  ///< names in small letters
    std::string body;
    bool whole = false;  ///< all that was promised has come
  };
  using Headers = std::vector<std::pair<std::string, std::string>>;

  Response get(const std::string& target, const Headers& headers = {}) const {
    return send("GET", target, {}, headers);
  }
  Response post(const std::string& target, const std::string& body = {},
                const Headers& headers = {}) const {
    return send("POST", target, body, headers);
  }
  Response send(const std::string& method, const std::string& target, const std::string& body = {},
                const Headers& headers = {}) const;
  /// What comes back for bytes that may be no HTTP at all.
  std::string exchange(const std::string& bytes) const;

  /// A stream of events, for 20 seconds at most a wait.
  class Events {
   public:
    Events(const HttpClient& client, const std::string& target, const Headers& headers = {});
    ~Events();
    Events(const Events&) = delete;
    Events& operator=(const Events&) = delete;

    struct Event {
      std::string name;  ///< empty: the stream has ended
      std::string data;
    };
    Event next();
    int status() const { return status_; }

   private:
    bool more();
    int socket_ = -1;
    int status_ = 0;
    std::string waiting_;
  };

 private:
  int connect() const;
  int port_ = 0;
};

}  // namespace hyades::coordinator
