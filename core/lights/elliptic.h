#pragma once

namespace hyades::core {

/// Carlson's symmetric elliptic integral R_G(x, y, z) of non-negative numbers, at most one of them
/// zero (DLMF 19.16.3). An ellipsoid of half axes a, b, c has area 4 pi R_G(a^2 b^2, a^2 c^2, b^2
/// c^2) (DLMF 19.33.1), an ellipse has perimeter 8 R_G(0, a^2, b^2).
double carlson_rg(double x, double y, double z);

}  // namespace hyades::core
