#pragma once

#include <memory>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include "coordinator/controller/controller.h"
#include "coordinator/operations/executors.h"
#include "coordinator/web/farm_feed.h"
#include "coordinator/web/io_handle.h"
#include "coordinator/web/router.h"

namespace hyades::coordinator {

/// What happens on the farm and with jobs, as server-sent events.
class LiveApi {
 public:
  /// What the arguments refer to outlives it.
  LiveApi(Controller& controller, Executors& executors, boost::asio::io_context& network,
          std::shared_ptr<IoHandle> io);
  void add_routes(Router& router);
  /// Begins to note the farm's throughput, whether anybody looks or not.
  void begin();

 private:
  void tick();

  Controller& controller_;
  Executors& executors_;
  std::shared_ptr<IoHandle> io_;
  boost::asio::steady_timer timer_;
  std::shared_ptr<FarmFeed> farm_;
};

}  // namespace hyades::coordinator
