#pragma once

#include <string>

namespace hyades::coordinator {

class Controller;

/// The coordinator's numbers in Prometheus' text format.
std::string metrics_text(Controller& controller);

}  // namespace hyades::coordinator
