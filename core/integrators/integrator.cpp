#include "core/integrators/integrator.h"

#include "core/integrators/bdpt.h"
#include "core/integrators/path.h"

namespace hyades::core {
namespace {

std::unique_ptr<Integrator> make_direct_view_integrator(const IntegratorDesc& desc) {
  IntegratorDesc direct = desc;
  direct.max_events = 0;
  return make_path_integrator(direct);
}

struct Maker {
  const char* name;
  std::unique_ptr<Integrator> (*make)(const IntegratorDesc&);
};

constexpr Maker kMakers[] = {
    {"path", make_path_integrator},
    {"bdpt", make_bdpt_integrator},
    {"mlt", make_direct_view_integrator},
};

}  // namespace

std::unique_ptr<Integrator> make_integrator(const IntegratorDesc& desc) {
  for (const Maker& maker : kMakers) {
    if (desc.type == maker.name) return maker.make(desc);
  }
  return nullptr;
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const Maker& maker : kMakers) names.emplace_back(maker.name);
  return names;
}

}  // namespace hyades::core
