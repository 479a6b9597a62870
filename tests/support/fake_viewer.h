#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace hyades::test {

/// A viewer as tev is one over the network: it takes packets, and notes every one that is not
/// exactly what the protocol says.
class FakeViewer {
 public:
  struct Picture {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;
    std::vector<float> values;  ///< row by row, the channels of a pixel together
    int updates = 0;
    int created = 0;  ///< how often
  };
  struct Seen {
    std::map<std::string, Picture> pictures;
    std::vector<std::string> created;  ///< names, in order
    std::vector<std::string> closed;
    std::vector<std::string> wrong;  ///< what was no packet of the protocol
    int connections = 0;
    uint64_t bytes = 0;
  };

  /// Listens at once; `port` 0 takes a free one.
  explicit FakeViewer(int port = 0);
  ~FakeViewer();

  int port() const;
  std::string address() const;

  /// Ends all connections and forgets its pictures, as a viewer that is closed; the port is free.
  void leave();
  /// Listens on the same port again.
  void come_back();
  /// From now on what comes stays unread, until `read_again`.
  void stop_reading();
  void read_again();
  /// Sends something to whoever is connected, which no viewer does.
  void babble(const std::string& bytes);

  Seen seen() const;
  /// Waits until `reached` holds, and returns whether it does in the end.
  bool wait_until(const std::function<bool(const Seen&)>& reached,
                  std::chrono::seconds limit = std::chrono::seconds(60)) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A port of this machine where nobody listens.
int free_port();

}  // namespace hyades::test
