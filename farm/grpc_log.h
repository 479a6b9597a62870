#pragma once

namespace hyades::farm {

/// Keeps gRPC's own lines off standard error: what goes wrong is told in our words, once. Whoever
/// looks for a fault of gRPC sets GRPC_VERBOSITY or GRPC_TRACE, and has them all. Idempotent.
void quiet_grpc();

}  // namespace hyades::farm
