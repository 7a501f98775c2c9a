// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>

/// The values that theory gives, in double precision and from no code of the solvers.
/// F is a configuration factor: a surface of luminance L that fills it brings E = pi L F.
namespace aglow::validation {

inline constexpr double kPi = 3.14159265358979323846;

struct Point {
    double x = 0, y = 0, z = 0;
};
inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point operator*(Point a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double dot(Point a, Point b);
Point cross(Point a, Point b);
double length(Point a);
Point unit(Point a);

/// F from an element at `at` with unit normal n to a planar convex polygon; the part below the
/// element's horizon does not count. Corners run clockwise seen from the element, which is
/// counter-clockwise seen from behind the polygon; the other winding gives a negative value.
/// Source  Lambert, Photometria, 1760; Hottel & Sarofim, Radiative Transfer, 1967.
double polygon_factor(Point at, Point n, std::span<const Point> corners);

/// The same for the parallelogram corner, corner + u, corner + u + v, corner + v; always positive.
double rectangle_factor(Point at, Point n, Point corner, Point u, Point v);

/// F from an element to a parallel w x d rectangle at distance h, one of whose corners lies on the
/// element's normal.  Source  Siegel & Howell, Thermal Radiation Heat Transfer, appendix C.
double corner_parallel(double w, double d, double h);

/// F from an element to a rectangle in a plane at right angles to its own that stands on the
/// element's plane: `width` along the line where the planes meet, from the foot of the element's
/// perpendicular on, `height` along the element's normal, `distance` away.
/// Source  Siegel & Howell, appendix C.
double corner_perpendicular(double width, double height, double distance);

/// F between two equal parallel rectangles a x b that face each other at distance c.
/// Source  Siegel & Howell, appendix C.
double facing_rectangles(double a, double b, double c);

/// F from a rectangle of depth w to one of height h at right angles, along a common edge of
/// length l.  Source  Siegel & Howell, appendix C.
double adjoining_rectangles(double h, double w, double l);

/// Spot falloff of KHR_lights_punctual at `angle` off the axis, all in radians.
double spot_falloff(double angle, double inner, double outer);

/// Flux of a spot of 1 cd: the integral of spot_falloff() over the sphere, lm.
double spot_flux(double inner, double outer);

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1].
struct Quadrature {
    static constexpr int kCount = 16;
    std::array<double, kCount> node{}, weight{};
    Quadrature();
};

/// Irradiance on the faces of a cube of edge 4 m with a point light of `flux` lumen in its middle
/// and walls of reflectance rho, after one reflection or more (the direct light left out).
struct CubeLight {
    double face_centre = 0;  ///< lx
    double mean = 0;         ///< lx, over the whole cube: exactly flux / 96 m^2 * rho / (1 - rho)
};

/// Solves the integral equation of radiosity in double precision; see docs/derivations/cube.md.
CubeLight cube_indirect(double flux, double rho);

}  // namespace aglow::validation
