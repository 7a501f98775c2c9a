// SPDX-License-Identifier: Apache-2.0
#include "aglow/shared/shading.h"

#include "aglow/shared/camera.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace aglow::shared;

namespace {

constexpr double kPi = 3.14159265358979323846;

vec3 direction(double theta, double phi) {
    return {float(std::sin(theta) * std::cos(phi)), float(std::sin(theta) * std::sin(phi)),
            float(std::cos(theta))};
}

/// Integral over the hemisphere about +z of f(direction) cos(theta), by the midpoint rule.
template <class F>
double over_hemisphere(const F& f) {
    constexpr int kTheta = 2000, kPhi = 64;
    double sum = 0;
    for (int i = 0; i < kTheta; ++i) {
        // Squeezed towards the pole, where lobes are narrow.
        const double s = (i + 0.5) / kTheta, theta = s * s * kPi / 2;
        const double measure = 2 * s * kPi / 2 / kTheta * std::sin(theta) * std::cos(theta);
        for (int k = 0; k < kPhi; ++k)
            sum += f(direction(theta, (k + 0.5) / kPhi * 2 * kPi)) * measure * 2 * kPi / kPhi;
    }
    return sum;
}

SurfaceColor surface(float c, float metallic, float roughness) {
    return {{c, c, c}, metallic, roughness, {0, 0, 0}};
}

}  // namespace

TEST_CASE("the projected area of all facets is that of the surface, however rough it is") {
    for (const float alpha : {0.01f, 0.1f, 0.3f, 0.7f, 1.0f}) {
        CAPTURE(alpha);
        CHECK(over_hemisphere([&](vec3 h) { return double(ggx_distribution(alpha, h.z)); }) ==
              doctest::Approx(1).epsilon(2e-3));
    }
}

TEST_CASE("a Phong lobe about the normal reflects all light, however narrow it is") {
    for (const float exponent : {0.0f, 1.0f, 10.0f, 200.0f, 5000.0f}) {
        CAPTURE(exponent);
        CHECK(over_hemisphere([&](vec3 l) { return double(phong_lobe(exponent, l.z)); }) ==
              doctest::Approx(1).epsilon(1e-3));
    }
}

TEST_CASE("a highlight reflects no more than what comes, and all but the masked part on metal") {
    const vec3 white{1, 1, 1}, n{0, 0, 1};
    for (const uint kind : {kHighlightGgx, kHighlightPhong})
        for (const float alpha : {0.1f, 0.5f, 1.0f})
            for (const double theta : {0.0, 0.6, 1.2}) {
                CAPTURE(kind);
                CAPTURE(alpha);
                CAPTURE(theta);
                const double reflected = over_hemisphere([&](vec3 l) {
                    return double(highlight(kind, white, alpha, n, direction(theta, 0), l).x);
                });
                CHECK(reflected < 1.005);
                if (theta == 0.0 && alpha < 0.2f) CHECK(reflected > 0.97);
            }
}

TEST_CASE("both lobes of a smooth surface peak in the mirror direction, about as high") {
    const vec3 white{1, 1, 1}, n{0, 0, 1}, v = direction(0.5, 0), l = direction(0.5, kPi);
    for (const float alpha : {0.02f, 0.1f}) {
        const float ggx = highlight(kHighlightGgx, white, alpha, n, v, l).x;
        const float phong = highlight(kHighlightPhong, white, alpha, n, v, l).x;
        CHECK(ggx > highlight(kHighlightGgx, white, alpha, n, v, direction(0.6, kPi)).x);
        CHECK(phong > highlight(kHighlightPhong, white, alpha, n, v, direction(0.6, kPi)).x);
        CHECK(phong / ggx == doctest::Approx(1).epsilon(0.5));
    }
}

TEST_CASE("Fresnel: 4 % of glass and the colour of a metal face on, everything at a glance") {
    for (const float roughness : {0.0f, 0.4f, 1.0f}) {
        const vec3 glass = rough_fresnel(normal_reflectance(surface(0.5f, 0, 0)), roughness, 1);
        CHECK(glass.x == doctest::Approx(0.04));
        const vec3 metal = rough_fresnel(normal_reflectance(surface(0.7f, 1, 0)), roughness, 1);
        CHECK(metal.x == doctest::Approx(0.7));
    }
    CHECK(rough_fresnel({0.04f, 0.04f, 0.04f}, 0, 0).x == doctest::Approx(1));
    CHECK(rough_fresnel({0.04f, 0.04f, 0.04f}, 1, 0).x == doctest::Approx(0.04));
}

TEST_CASE("no surface is brighter than a uniform surrounding") {
    const vec3 one{1, 1, 1};
    for (int c = 0; c <= 10; ++c)
        for (int m = 0; m <= 4; ++m)
            for (int r = 0; r <= 10; ++r)
                for (const float cosine : {0.0f, 0.05f, 0.3f, 1.0f})
                    for (const uint mirrors : {0u, 1u}) {
                        const SurfaceLook look =
                            surface_look(surface(float(c) / 8, float(m) / 4, float(r) / 10), cosine,
                                         one, mirrors);
                        const double sum =
                            kPi * double(look.diffuse.x + look.mean.x) + double(look.mirror.x);
                        CHECK(sum <= 1 + 1e-6);
                        CHECK(look.diffuse.x >= 0);
                        CHECK(look.mean.x >= 0);
                    }
}

TEST_CASE("mirror images fade where roughness grows, and are not traced where they are too faint") {
    CHECK(mirror_share(0.3f) == 1);
    CHECK(mirror_share(0.4f) == doctest::Approx(0.5));
    CHECK(mirror_share(0.5f) == 0);
    const vec3 faint{0.05f, 0.05f, 0.05f};
    CHECK(surface_look(surface(0.5f, 0, 0), 1, faint, 1).mirror == vec3{0, 0, 0});
    CHECK(surface_look(surface(0.5f, 1, 0), 1, faint, 1).mirror.x > 0);
}

TEST_CASE("a mirror ray never enters the surface") {
    const vec3 g{0, 0, 1};
    for (int i = 0; i < 64; ++i) {
        const vec3 n = direction(0.7, i * 0.1), d = -direction(1.5, i * 0.37);
        const vec3 r = mirror_direction(d, n, g);
        CHECK(dot(r, g) >= 0);
        CHECK(length(r) == doctest::Approx(1));
    }
}

TEST_CASE("points of a faceted sphere are lifted onto it, those of a hollow one stay") {
    // An octant's face; the sphere is 1/sqrt(3) - ... above its middle: normals are the corners.
    const Triangle face{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const vec2 middle{1 / 3.0f, 1 / 3.0f};
    const vec3 p = (face.a + face.b + face.c) / 3;
    const vec3 lifted = lifted_point(p, middle, face, face.a, face.b, face.c);
    // Each corner's tangent plane is 2/3 above p along its own normal, weighted by 1/3.
    CHECK(lifted.x == doctest::Approx(1 / 3.0 + 2 / 9.0));
    CHECK(length(lifted) < 1.0);
    CHECK(length(lifted) > length(p));
    CHECK(lifted_point(p, middle, face, -face.a, -face.b, -face.c) == p);
}

TEST_CASE("the curvature of a triangle on a sphere is that of the sphere") {
    for (const float radius : {0.5f, 4.0f}) {
        vec3 n[3];
        for (int i = 0; i < 3; ++i) n[i] = direction(0.01, i * 2.1);
        const Triangle t{n[0] * radius, n[1] * radius, n[2] * radius};
        CHECK(triangle_curvature(t, n[0], n[1], n[2]) == doctest::Approx(1 / radius));
        CHECK(triangle_curvature(t, -n[0], -n[1], -n[2]) == doctest::Approx(-1 / radius));
    }
}
