#pragma once

#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// The readers of a topic: some know how things are and are told of changes, some have just come
/// and are told everything first. Not thread-safe.
class LiveReaders {
 public:
  using Group = std::vector<std::weak_ptr<LiveReader>>;
  using Bytes = std::shared_ptr<const std::string>;

  /// Adds one who has just come.
  void add(std::weak_ptr<LiveReader> reader) { fresh_.push_back(std::move(reader)); }
  bool has_fresh() const { return !fresh_.empty(); }
  /// Takes out those who have just come, to be told everything.
  Group take_fresh() { return std::exchange(fresh_, {}); }
  /// Adds those who have been told everything: from now on they know.
  void know(Group readers) {
    known_.insert(known_.end(), std::make_move_iterator(readers.begin()),
                  std::make_move_iterator(readers.end()));
  }

  /// Sends an event to those who know.
  void tell(const Bytes& event) const { tell(known_, event); }
  /// Ends the streams of those who know.
  void end() { end(std::exchange(known_, {})); }

  /// An event as bytes of server-sent events. Takes its time where `data` is large.
  static Bytes event(const char* name, const farm::Json& data) {
    return std::make_shared<const std::string>(
        fmt::format("event: {}\ndata: {}\n\n", name,
                    data.dump(-1, ' ', false, farm::Json::error_handler_t::replace)));
  }
  /// Sends an event to all of a group, who share its bytes.
  static void tell(const Group& readers, const Bytes& event) {
    for (const auto& weak : readers) {
      if (const auto reader = weak.lock()) reader->push(event);
    }
  }
  /// Ends the streams of a group.
  static void end(const Group& readers) {
    for (const auto& weak : readers) {
      if (const auto reader = weak.lock()) reader->end();
    }
  }

  /// Whether nobody is left.
  bool empty() {
    std::erase_if(known_, [](const auto& reader) { return reader.expired(); });
    std::erase_if(fresh_, [](const auto& reader) { return reader.expired(); });
    return known_.empty() && fresh_.empty();
  }

 private:
  Group known_;
  Group fresh_;
};

}  // namespace hyades::coordinator
