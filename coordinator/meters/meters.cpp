#include "coordinator/meters/meters.h"

#include <cstddef>

#include "core/base/duration.h"

namespace hyades::coordinator {
using core::seconds;

namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;
using Buckets = Histogram::BucketBoundaries;

/// Seconds, for what mostly takes parts of a millisecond.
const Buckets& quick() {
  static const Buckets buckets{0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3};
  return buckets;
}

/// Seconds, for what waits for a disk or a program.
const Buckets& slow() {
  static const Buckets buckets{0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30};
  return buckets;
}

Family<Counter>& counters(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

Family<Histogram>& histograms(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
}

}  // namespace

Meters::Meters()
    : leased_(counters(registry_, "hyades_leased_units_total",
                       "Units that were leased, by whether the worker had them already")),
      lost_(counters(registry_, "hyades_lost_units_total",
                     "Leased units of which no result came, by what became of them")),
      results_(counters(registry_, "hyades_results_total",
                        "Results of workers, by what became of them")),
      calls_(counters(registry_, "hyades_grpc_calls_total", "Calls that are over")),
      received_(counters(registry_, "hyades_grpc_received_bytes_total", "Bytes of messages")),
      sent_(counters(registry_, "hyades_grpc_sent_bytes_total", "Bytes of messages")),
      call_seconds_{histograms(registry_, "hyades_grpc_call_seconds",
                               "From a call's beginning to its end, but for streams"),
                    "method"},
      answers_(counters(registry_, "hyades_http_requests_total", "Requests that were answered")),
      answer_seconds_{histograms(registry_, "hyades_http_request_seconds",
                                 "From a whole request to its answer"),
                      "route"},
      workers_lost_(&counters(registry_, "hyades_workers_lost_total",
                              "Workers that are gone and had not said that they leave")
                         .Add({})),
      film_bytes_(
          &counters(registry_, "hyades_film_bytes_total", "Bytes of films that came").Add({})),
      http_bytes_(
          &counters(registry_, "hyades_http_sent_bytes_total", "Bytes of answers' bodies").Add({})),
      http_connections_(&prometheus::BuildGauge()
                             .Name("hyades_http_connections")
                             .Help("Connections that are open")
                             .Register(registry_)
                             .Add({})),
      merge_(&histograms(registry_, "hyades_merge_seconds", "A film merged into its frame's film")
                  .Add({}, quick())),
      sync_(
          &histograms(registry_, "hyades_film_sync_seconds", "A group of films synced to the disk")
               .Add({}, slow())),
      durable_(&histograms(registry_, "hyades_result_seconds",
                           "From a result's arrival until it is durable and merged")
                    .Add({}, slow())),
      finish_(&histograms(registry_, "hyades_finish_seconds", "A frame's outputs made")
                   .Add({}, slow())) {
  // What may happen is told as 0 before it does, so that rates see the first time too.
  for (const char* adopted : {"no", "yes"}) leased_.Add({{"adopted", adopted}});
  for (const char* how : {"failed", "returned", "expired", "stalled", "revoked"}) {
    lost_.Add({{"how", how}});
  }
  for (const char* verdict : {"accepted", "duplicate", "waits", "damaged", "malformed", "unknown",
                              "overlap", "conflict", "not_now"}) {
    results_.Add({{"verdict", verdict}});
  }
}

void Meters::leased(size_t units, bool adopted) {
  leased_.Add({{"adopted", adopted ? "yes" : "no"}}).Increment(static_cast<double>(units));
}

void Meters::lost(const char* how) { lost_.Add({{"how", how}}).Increment(); }

void Meters::result(const char* verdict) { results_.Add({{"verdict", verdict}}).Increment(); }

void Meters::merged(Time took) { merge_->Observe(seconds(took)); }
void Meters::synced(Time took) { sync_->Observe(seconds(took)); }
void Meters::made_durable(Time took) { durable_->Observe(seconds(took)); }
void Meters::finished(Time took) { finish_->Observe(seconds(took)); }

void Meters::called(const std::string& method, const char* code, bool unary, Time took) {
  calls_.Add({{"method", method}, {"code", code}}).Increment();
  if (unary) call_seconds_.of(method).Observe(seconds(took));
}

void Meters::call_bytes(const std::string& method, uint64_t received, uint64_t sent) {
  if (received > 0) received_.Add({{"method", method}}).Increment(static_cast<double>(received));
  if (sent > 0) sent_.Add({{"method", method}}).Increment(static_cast<double>(sent));
}

void Meters::answered(const std::string& method, const std::string& route, unsigned status,
                      Time took) {
  answers_.Add({{"method", method}, {"route", route}, {"code", std::to_string(status)}})
      .Increment();
  answer_seconds_.of(route).Observe(seconds(took));
}

Histogram& Meters::Histograms::of(const std::string& text) {
  const core::MutexLock lock(mutex);
  Histogram*& histogram = known[text];
  if (histogram == nullptr) histogram = &family.Add({{label, text}}, quick());
  return *histogram;
}

}  // namespace hyades::coordinator
