#pragma once

#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// Those who read a topic: some know how things are and are told of changes, some have just come
/// and are told everything first. Not thread-safe.
class LiveReaders {
 public:
  using Group = std::vector<std::weak_ptr<LiveReader>>;

  void add(std::weak_ptr<LiveReader> reader) { fresh_.push_back(std::move(reader)); }
  /// Those who have just come, to be told everything.
  Group take_fresh() { return std::exchange(fresh_, {}); }
  /// They could not be.
  void put_back(Group readers) { append(fresh_, std::move(readers)); }
  /// They have been: from now on they know.
  void know(Group readers) { append(known_, std::move(readers)); }

  /// An event for those who know.
  void tell(const char* event, const farm::Json& data) const { tell(known_, event, data); }
  /// Nothing more will come for those who know.
  void end() { end(std::exchange(known_, {})); }

  /// The same bytes for all of a group.
  static void tell(const Group& readers, const char* event, const farm::Json& data) {
    if (readers.empty()) return;
    const auto bytes = std::make_shared<const std::string>(
        fmt::format("event: {}\ndata: {}\n\n", event,
                    data.dump(-1, ' ', false, farm::Json::error_handler_t::replace)));
    for (const auto& weak : readers) {
      if (const auto reader = weak.lock()) reader->push(bytes);
    }
  }
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
  static void append(Group& to, Group readers) {
    to.insert(to.end(), std::make_move_iterator(readers.begin()),
              std::make_move_iterator(readers.end()));
  }

  Group known_;
  Group fresh_;
};

}  // namespace hyades::coordinator
