#include "coordinator/access/caller.h"

#include "coordinator/access/address.h"

namespace hyades::coordinator {

farm::ByteBudget::Owner owner_of(const Caller& caller) {
  if (caller.name.empty()) return {neighbourhood_of(caller.address)};
  return {caller.name, caller.worker};
}

}  // namespace hyades::coordinator
