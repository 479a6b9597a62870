#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include "coordinator/controller/all_pages.h"
#include "coordinator/controller/controller.h"
#include "coordinator/meters/meters.h"
#include "coordinator/web/route_helpers.h"
#include "coordinator/web/routes.h"
#include "core/base/version.h"
#include "farm/json_form.h"

namespace hyades::coordinator {
namespace {

/// Rows for each of them; what is beyond is counted.
constexpr uint64_t kMostWorkers = 1000;
/// Of tags, which anybody may invent who may submit.
constexpr size_t kMostTags = 100;
constexpr const char* kOtherTags = "(others)";

using Labels = std::vector<std::pair<const char*, std::string>>;

/// Families of numbers, in the order in which they were named.
class Page {
 public:
  void add(prometheus::MetricType type, const char* name, const char* help, double value,
           const Labels& labels = {}) {
    if (families_.empty() || families_.back().name != name) {
      families_.push_back({name, help, type, {}});
    }
    prometheus::ClientMetric metric;
    for (const auto& [label, text] : labels) metric.label.push_back({label, text});
    if (type == prometheus::MetricType::Counter) {
      metric.counter.value = value;
    } else {
      metric.gauge.value = value;
    }
    families_.back().metric.push_back(std::move(metric));
  }
  void gauge(const char* name, const char* help, double value, const Labels& labels = {}) {
    add(prometheus::MetricType::Gauge, name, help, value, labels);
  }
  void counter(const char* name, const char* help, double value, const Labels& labels = {}) {
    add(prometheus::MetricType::Counter, name, help, value, labels);
  }
  void add(std::vector<prometheus::MetricFamily> families) {
    for (prometheus::MetricFamily& family : families) families_.push_back(std::move(family));
  }
  std::string text() const { return prometheus::TextSerializer().Serialize(families_); }

 private:
  std::vector<prometheus::MetricFamily> families_;
};

void add_leads(Page& page, bool leads) {
  page.gauge("hyades_coordinator_leads",
             "1 where this coordinator leads the farm, 0 where it stands by", leads ? 1 : 0);
}

void add_workers(Page& page, const std::vector<v1::Worker>& workers) {
  std::map<std::string, uint64_t> states;
  for (const char* state : {"active", "draining", "quarantined", "gone"}) states[state] = 0;
  for (const v1::Worker& worker : workers) ++states[farm::state_name(worker.state())];
  for (const auto& [state, count] : states) {
    page.gauge("hyades_workers", "Workers that are known, by state", static_cast<double>(count),
               {{"state", state}});
  }
  uint64_t here = 0;
  for (const v1::Worker& worker : workers) here += worker.state() != v1::WORKER_STATE_GONE ? 1 : 0;
  page.gauge("hyades_workers_left_out", "Connected workers that have no rows of their own here",
             static_cast<double>(here - std::min(here, kMostWorkers)));
  const auto each = [&](auto add) {
    uint64_t shown = 0;
    for (const v1::Worker& worker : workers) {
      if (worker.state() == v1::WORKER_STATE_GONE || ++shown > kMostWorkers) continue;
      add(worker, Labels{{"worker", std::to_string(worker.id())}, {"name", worker.name()}});
    }
  };
  each([&](const v1::Worker& worker, const Labels& labels) {
    page.gauge("hyades_worker_threads", "Threads that render", worker.threads(), labels);
  });
  each([&](const v1::Worker& worker, const Labels& labels) {
    page.gauge("hyades_worker_units_leased", "Units that are out with the worker", worker.leased(),
               labels);
  });
  each([&](const v1::Worker& worker, const Labels& labels) {
    page.counter("hyades_worker_samples_total", "Samples of accepted units",
                 static_cast<double>(worker.samples_done()), labels);
  });
  each([&](const v1::Worker& worker, const Labels& labels) {
    page.counter("hyades_worker_units_total", "Accepted units",
                 static_cast<double>(worker.units_done()), labels);
  });
  each([&](const v1::Worker& worker, const Labels& labels) {
    page.counter("hyades_worker_units_failed_total", "Units that failed on the worker",
                 static_cast<double>(worker.units_failed()), labels);
  });
  each([&](const v1::Worker& worker, const Labels& labels) {
    page.gauge("hyades_worker_samples_per_second", "Samples that became durable, lately",
               worker.samples_per_second(), labels);
  });
  each([&](const v1::Worker& worker, const Labels& labels) {
    page.gauge("hyades_worker_cache_bytes", "Assets on the worker's disk",
               static_cast<double>(worker.cache_bytes()), labels);
  });
  each([&](const v1::Worker& worker, const Labels& labels) {
    page.gauge("hyades_worker_memory_bytes", "Resident memory",
               static_cast<double>(worker.memory_bytes()), labels);
  });
}

void add_jobs(Page& page, const std::vector<v1::Job>& jobs) {
  std::map<std::string, uint64_t> states{{"running", 0}, {"paused", 0}};
  std::map<std::string, double> waiting{{"", 0}};
  uint64_t leased = 0;
  for (const v1::Job& job : jobs) {
    ++states[farm::state_name(job.state())];
    leased += job.leased();
    const auto left =
        static_cast<double>(job.samples() - std::min(job.samples(), job.samples_done()));
    // A job counts for each tag that it asks for.
    if (job.tags().empty()) waiting[""] += left;
    for (const std::string& tag : std::set<std::string>(job.tags().begin(), job.tags().end())) {
      const bool known = waiting.contains(tag) || waiting.size() < kMostTags;
      waiting[known ? tag : kOtherTags] += left;
    }
  }
  for (const auto& [state, count] : states) {
    page.gauge("hyades_jobs", "Jobs that have not ended, by state", static_cast<double>(count),
               {{"state", state}});
  }
  page.gauge("hyades_units_leased", "Units that are out with workers", static_cast<double>(leased));
  for (const auto& [tag, samples] : waiting) {
    page.gauge("hyades_queue_samples",
               "Samples that open jobs have left, by the tag that they ask of workers", samples,
               {{"tag", tag}});
  }
}

/// The coordinator's numbers in Prometheus' text format.
std::string metrics_text(Controller& controller) {
  v1::InfoResponse info;
  controller.farm().info(info);
  Page page;
  page.gauge("hyades_build_info", "1, with the version", 1, {{"version", info.version()}});
  page.gauge("hyades_start_time_seconds", "When the coordinator started, since 1970",
             static_cast<double>(info.started_ms()) / 1000);
  add_leads(page, true);
  page.gauge("hyades_trouble",
             "1 where something keeps the coordinator from storing what it is given",
             info.trouble().empty() ? 0 : 1);
  page.gauge("hyades_render_threads", "Threads of all connected workers", info.threads());
  add_jobs(page, all_open_jobs(controller));
  add_workers(page, all_workers(controller));
  page.add(controller.meters().collect());
  return page.text();
}

}  // namespace

std::string standby_metrics() {
  Page page;
  add_leads(page, false);
  return page.text();
}

void add_metrics(Router& router, Controller& controller, Executors& executors) {
  router.add("GET", "/metrics", [&](const WebRequest& request, const Answer& answer) {
    answer_by(executors, "GET /metrics", request.caller, answer,
              [&controller] { return text_reply(metrics_text(controller), kMetricsType); });
  });
}

}  // namespace hyades::coordinator
