#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include "core/base/mutex.h"

namespace hyades::coordinator {

/// What the coordinator counts while it works, for /metrics (docs/dashboard.md has the table).
/// Labels come from fixed sets only (states, reasons, our own methods and routes), never from what
/// others send, so that the number of rows is bounded. Thread-safe; counting costs some
/// nanoseconds, with a label a look-up.
class Meters {
 public:
  Meters();

  /// Units that were leased: new ones, or those that workers had already (`adopted`).
  void leased(size_t units, bool adopted);
  /// What became of a unit that was leased, other than a result: "failed", "returned",
  /// "expired", "stalled", "revoked".
  void lost(const char* how);
  /// A worker is gone that had not said that it leaves.
  void worker_lost() { workers_lost_->Increment(); }
  /// What became of a result: "accepted", "duplicate", "waits" (for others that are compared with
  /// it), or why it was refused.
  void result(const char* verdict);
  /// Bytes of a result's film, as they came.
  void film_bytes(uint64_t bytes) { film_bytes_->Increment(static_cast<double>(bytes)); }

  using Time = std::chrono::nanoseconds;
  // What took how long.
  void merged(Time took);        ///< a film into its frame's film
  void synced(Time took);        ///< a group of films to the disk
  void made_durable(Time took);  ///< from a result's arrival to its acknowledgement
  void finished(Time took);      ///< a frame's outputs

  /// A call of gRPC is over: "Jobs/List", "OK". `unary`: its time says something.
  void called(const std::string& method, const char* code, bool unary, Time took);
  /// Bytes of messages of such a call.
  void call_bytes(const std::string& method, uint64_t received, uint64_t sent);

  /// A request over HTTP is answered; `route` is the pattern that it matched.
  void answered(const std::string& method, const std::string& route, unsigned status, Time took);
  /// Bytes of an answer's body.
  void http_bytes(uint64_t sent) { http_bytes_->Increment(static_cast<double>(sent)); }
  /// How many connections of HTTP are open.
  prometheus::Gauge& http_connections() { return *http_connections_; }

  /// All that is counted, as it is now.
  std::vector<prometheus::MetricFamily> collect() const { return registry_.Collect(); }

 private:
  template <class T>
  using Family = prometheus::Family<T>;
  /// One histogram for each text of a label, made when it is first wanted.
  struct Histograms {
    prometheus::Histogram& of(const std::string& text) HYADES_EXCLUDES(mutex);

    Family<prometheus::Histogram>& family;
    const char* label;
    core::Mutex mutex{};
    std::map<std::string, prometheus::Histogram*> known HYADES_GUARDED_BY(mutex){};
  };

  prometheus::Registry registry_;
  Family<prometheus::Counter>& leased_;
  Family<prometheus::Counter>& lost_;
  Family<prometheus::Counter>& results_;
  Family<prometheus::Counter>& calls_;
  Family<prometheus::Counter>& received_;
  Family<prometheus::Counter>& sent_;
  Histograms call_seconds_;
  Family<prometheus::Counter>& answers_;
  Histograms answer_seconds_;
  prometheus::Counter* workers_lost_;
  prometheus::Counter* film_bytes_;
  prometheus::Counter* http_bytes_;
  prometheus::Gauge* http_connections_;
  prometheus::Histogram* merge_;
  prometheus::Histogram* sync_;
  prometheus::Histogram* durable_;
  prometheus::Histogram* finish_;
};

}  // namespace hyades::coordinator
