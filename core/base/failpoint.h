#pragma once

namespace hyades::core {

/// A named place where a test may end the process, as kill -9 would: HYADES_FAILPOINT=NAME does so
/// at the first visit, NAME:N at the N-th. Without that variable it costs a load and a branch.
void failpoint(const char* name);

}  // namespace hyades::core
