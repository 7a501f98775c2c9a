// SPDX-License-Identifier: Apache-2.0
#include "aglow/bake/validate/closed_forms.h"

#include <cmath>
#include <vector>

namespace aglow::validation {

Quadrature::Quadrature() {
    for (int i = 0; i < kCount; ++i) {
        // Newton's method on the Legendre polynomial of degree kCount, from Tricomi's estimate.
        double x = std::cos(kPi * (i + 0.75) / (kCount + 0.5));
        double slope = 1;
        for (int step = 0; step < 20; ++step) {
            double before = 1, value = x;
            for (int k = 2; k <= kCount; ++k) {
                const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
                before = value;
                value = next;
            }
            slope = kCount * (x * value - before) / (x * x - 1);
            x -= value / slope;
        }
        node[static_cast<size_t>(i)] = x;
        weight[static_cast<size_t>(i)] = 2 / ((1 - x * x) * slope * slope);
    }
}

namespace {

constexpr double kHalfEdge = 2;  // metres
constexpr int kSteps = 200;      // of Gauss-Seidel; the error falls below 1e-12 for rho <= 0.8

struct Node {
    double x, y, weight;
};

/// cos cos / (pi r^2) between an element at (x, y) of the floor and one at `q` with normal `n`.
double kernel(Point floor, Point q, Point n) {
    const Point d = q - floor;
    const double rr = dot(d, d);
    return std::fabs(d.z * dot(d, n)) / (kPi * rr * rr);
}

/// What the points (x, y) of the five other faces together send to `p` of the floor. By symmetry
/// every face carries the same light, as a function of its own coordinates; x and y of a wall run
/// so that y is the height, but the light is even in both.
double five_faces(Point p, double x, double y) {
    const double a = kHalfEdge;
    return kernel(p, {x, y, a}, {0, 0, -1}) + kernel(p, {-a, x, y}, {1, 0, 0}) +
           kernel(p, {a, x, y}, {-1, 0, 0}) + kernel(p, {x, -a, y}, {0, 1, 0}) +
           kernel(p, {x, a, y}, {0, -1, 0});
}

double direct(double flux, double x, double y) {
    const double rr = x * x + y * y + kHalfEdge * kHalfEdge;
    return flux / (4 * kPi) * kHalfEdge / (rr * std::sqrt(rr));
}

std::vector<Node> face_nodes() {
    const Quadrature q;
    std::vector<Node> nodes;
    for (size_t i = 0; i < q.node.size(); ++i)
        for (size_t j = 0; j < q.node.size(); ++j)
            nodes.push_back({kHalfEdge * q.node[i], kHalfEdge * q.node[j],
                             kHalfEdge * kHalfEdge * q.weight[i] * q.weight[j]});
    return nodes;
}

/// Weight of every node's light at one point of the floor, and their sum.
struct Row {
    std::vector<double> weights;
    double sum = 0;
    Row(const std::vector<Node>& nodes, double x, double y) {
        for (const Node& node : nodes) {
            weights.push_back(node.weight * five_faces({x, y, -kHalfEdge}, node.x, node.y));
            sum += weights.back();
        }
    }
    double gather(const std::vector<double>& light) const {
        double total = 0;
        for (size_t j = 0; j < light.size(); ++j) total += weights[j] * light[j];
        return total;
    }
};

}  // namespace

CubeLight cube_indirect(double flux, double rho) {
    const std::vector<Node> nodes = face_nodes();
    std::vector<Row> rows;
    std::vector<double> first, light;
    for (const Node& node : nodes) {
        rows.emplace_back(nodes, node.x, node.y);
        first.push_back(direct(flux, node.x, node.y));
    }
    // The form factors of a closed room sum to 1, so the quadrature needs to resolve only how the
    // light differs from that of the receiving point: that takes the kernel's peak at edges away.
    // The receiver's own share goes to the left side, which makes every step a contraction.
    const auto solve_row = [rho](const Row& row, double direct_light, const auto& sent) {
        return (direct_light + rho * row.gather(sent)) / (1 - rho + rho * row.sum);
    };
    light = first;
    for (int step = 0; step < kSteps; ++step)
        for (size_t i = 0; i < nodes.size(); ++i) light[i] = solve_row(rows[i], first[i], light);

    const Row centre(nodes, 0, 0);
    CubeLight result;
    result.face_centre = solve_row(centre, direct(flux, 0, 0), light) - direct(flux, 0, 0);
    for (size_t i = 0; i < nodes.size(); ++i)
        result.mean += nodes[i].weight * (light[i] - first[i]) / (4 * kHalfEdge * kHalfEdge);
    return result;
}

}  // namespace aglow::validation
