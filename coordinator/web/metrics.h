#pragma once

#include <string>

namespace hyades::coordinator {

class Brain;

/// The coordinator's numbers in Prometheus' text format.
std::string metrics_text(Brain& brain);

}  // namespace hyades::coordinator
