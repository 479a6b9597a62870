#pragma once

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// Those who read a topic: some know how things are and are told of changes, some have just come
/// and are told everything first. Not thread-safe.
class LiveReaders {
 public:
  void add(std::weak_ptr<LiveReader> reader) { fresh_.push_back(std::move(reader)); }
  bool has_fresh() const { return !fresh_.empty(); }

  /// An event for those who know.
  void tell(const char* event, const farm::Json& data) { push(known_, frame(event, data)); }
  /// Everything, for those who have just come; from now on they know.
  void greet(const farm::Json& snapshot) {
    push(fresh_, frame("snapshot", snapshot));
    for (auto& reader : fresh_) known_.push_back(std::move(reader));
    fresh_.clear();
  }
  /// Nothing more will come.
  void end() {
    for (const auto& weak : known_) {
      if (const auto reader = weak.lock()) reader->end();
    }
    known_.clear();
  }

  /// Whether nobody is left.
  bool empty() {
    std::erase_if(known_, [](const auto& reader) { return reader.expired(); });
    std::erase_if(fresh_, [](const auto& reader) { return reader.expired(); });
    return known_.empty() && fresh_.empty();
  }

 private:
  static std::shared_ptr<const std::string> frame(const char* event, const farm::Json& data) {
    return std::make_shared<const std::string>(
        fmt::format("event: {}\ndata: {}\n\n", event,
                    data.dump(-1, ' ', false, farm::Json::error_handler_t::replace)));
  }
  static void push(const std::vector<std::weak_ptr<LiveReader>>& readers,
                   const std::shared_ptr<const std::string>& bytes) {
    for (const auto& weak : readers) {
      if (const auto reader = weak.lock()) reader->push(bytes);
    }
  }

  std::vector<std::weak_ptr<LiveReader>> known_;
  std::vector<std::weak_ptr<LiveReader>> fresh_;
};

}  // namespace hyades::coordinator
