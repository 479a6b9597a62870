#pragma once

#include "core/geometry/embree.h"
#include "core/geometry/placed_object.h"

namespace hyades::core {

/// Triangles that share the memory of `buffers`, which must outlive the scene.
RTCGeometry new_mesh_geometry(RTCDevice device, const MeshBuffers& buffers, unsigned mask);

/// Round curves that share the memory of `curves`, which must outlive the scene.
RTCGeometry new_curve_geometry(RTCDevice device, const CurveSet& curves, unsigned mask);

/// A quadric (perhaps moving) as user geometry; `object` must outlive the scene at its address.
RTCGeometry new_quadric_geometry(RTCDevice device, const PlacedObject& object, unsigned mask);

/// An instance of `scene` under the matrices of `motion`.
RTCGeometry new_instance_geometry(RTCDevice device, RTCScene scene, const Motion& motion,
                                  unsigned mask);

/// The copies of an instancer as user geometry whose primitives are the copies: a ray that comes
/// near one is transformed, and traced in the world that is copied. Debian's Embree has one level
/// of instances, of half a kilobyte each; this takes a fifth of that, and what is copied may hold
/// instances in its turn. A hit's Ng_x and Ng_y hold the numbers of the copy and of the placement
/// in it. `copies` must outlive the scene at its address.
RTCGeometry new_copies_geometry(RTCDevice device, const InstancerScene& copies);

}  // namespace hyades::core
