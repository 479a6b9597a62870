#pragma once

#include <string>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

// Routes that are served by hand and keep nothing, by subject. Controller and executors outlive the
// router.

/// The dashboard's files: / (its views have addresses behind a '#'), /dashboard/NAME,
/// /openapi.yaml.
void add_dashboard(Router& router);
/// Whether the coordinator is well: /healthz, /readyz.
void add_health_routes(Router& router, Controller& controller, Executors& executors);
/// Numbers for Prometheus: /metrics, as a text of this media type.
inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";
void add_metrics(Router& router, Controller& controller, Executors& executors);
/// What /metrics tells of a coordinator that stands by.
std::string standby_metrics();
/// A job's log, page by page, and its document.
void add_job_routes(Router& router, Controller& controller, Executors& executors);
/// A job's finished files: told, shown, downloaded one by one or all together.
void add_output_routes(Router& router, Controller& controller, Executors& executors);

}  // namespace hyades::coordinator
