#pragma once

/// The functions of job expressions, on doubles, with the same bits on every machine: only + - * /
/// sqrt floor fmod, and elementary.h behind an exact range reduction.
namespace hyades::core::expression {

double sin(double radians);
double cos(double radians);
double tan(double radians);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);
double exp(double x);
double log(double x);
double pow(double x, double y);  ///< whole |y| <= 64 by multiplication, any x; else x >= 0
double mod(double a, double b);  ///< a - b floor(a / b): has the sign of b
double round(double x);          ///< halves go up
double clamp(double x, double low, double high);
double lerp(double a, double b, double u);        ///< (1 - u) a + u b
double smoothstep(double a, double b, double x);  ///< 0 before a, 1 after b, 3u^2 - 2u^3 between

/// Gradient noise on a line: 0 at whole x, mean 0, within [-1, 1], smooth (Perlin's quintic fade).
double noise(double x);

}  // namespace hyades::core::expression
