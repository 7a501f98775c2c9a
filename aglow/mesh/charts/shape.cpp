// SPDX-License-Identifier: Apache-2.0
#include "aglow/mesh/charts/shape.h"

#include <Eigen/Dense>

#include <cmath>

namespace aglow::mesh {
namespace {

Eigen::Matrix3d linear_part(const mat4& transform) {
    Eigen::Matrix3d linear;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            linear(row, column) = double(transform.at(row, column));
    return linear;
}

/// Square root of the mean of A^T A over the placements: the symmetric map that measures lengths
/// as the placements do on average. The identity where all placements are flat or of no size.
Eigen::Matrix3d mean_metric(const std::vector<Eigen::Matrix3d>& maps) {
    Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
    for (const Eigen::Matrix3d& map : maps) {
        const double size = (map.transpose() * map).trace();
        // Every placement counts alike, whatever its size: what matters is the shape.
        if (size > 0) mean += map.transpose() * map / size;
    }
    if (maps.size() == 1) mean = maps[0].transpose() * maps[0];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(mean);
    if (solver.info() != Eigen::Success || !(solver.eigenvalues().maxCoeff() > 0))
        return Eigen::Matrix3d::Identity();
    return solver.operatorSqrt();
}

double total_area(const std::vector<Point3>& positions, const std::vector<uvec3>& triangles) {
    double area = 0;
    for (const uvec3& t : triangles)
        area += length(cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x])) / 2;
    return area;
}

std::vector<Point3> mapped(const std::vector<Point3>& positions, const Eigen::Matrix3d& map) {
    std::vector<Point3> result;
    result.reserve(positions.size());
    for (const Point3& p : positions) {
        const Eigen::Vector3d q = map * Eigen::Vector3d(p.x, p.y, p.z);
        result.push_back({q.x(), q.y(), q.z()});
    }
    return result;
}

void append(std::vector<Point3>& to, const std::vector<vec3>& from) {
    for (const vec3& p : from) to.push_back({double(p.x), double(p.y), double(p.z)});
}

/// Skinned meshes are charted as their first placement poses them.
std::vector<Point3> posed_positions(const Scene& scene, const NodePoses& poses,
                                    const PlacedMesh& placed) {
    std::vector<Point3> positions;
    for (const Primitive& primitive : scene.meshes[static_cast<size_t>(placed.mesh)].primitives)
        append(positions, pose_primitive(scene, poses, placed, primitive).positions);
    return positions;
}

std::vector<Point3> own_positions(const Scene& scene, const NodePoses& poses,
                                  const PlacedMesh& placed) {
    std::vector<Point3> positions;
    for (const Primitive& primitive : scene.meshes[static_cast<size_t>(placed.mesh)].primitives)
        append(positions,
               morphed_positions(primitive, poses.weights[static_cast<size_t>(placed.node)]));
    return positions;
}

void append_triangles(const Mesh& mesh, MeshShape& shape) {
    uint32_t offset = 0;
    shape.first_triangle = {0};
    for (const Primitive& primitive : mesh.primitives) {
        for (const uvec3& t : primitive.triangles)
            shape.triangles.push_back({t.x + offset, t.y + offset, t.z + offset});
        offset += static_cast<uint32_t>(primitive.positions.size());
        shape.first_triangle.push_back(shape.triangles.size());
    }
}

}  // namespace

MeshShape mesh_shape(const Scene& scene, const NodePoses& poses,
                     const std::vector<PlacedMesh>& placements) {
    MeshShape shape;
    append_triangles(scene.meshes[static_cast<size_t>(placements[0].mesh)], shape);
    const auto skinned = [&](const PlacedMesh& placed) {
        return scene.nodes[static_cast<size_t>(placed.node)].skin >= 0;
    };
    const std::vector<Point3> own = own_positions(scene, poses, placements[0]);
    std::vector<Eigen::Matrix3d> maps;
    for (const PlacedMesh& placed : placements)
        maps.push_back(linear_part(placement_transform(scene, poses, placed)));
    if (skinned(placements[0]))
        shape.positions = posed_positions(scene, poses, placements[0]);
    else
        shape.positions = mapped(own, mean_metric(maps));

    const double area = total_area(shape.positions, shape.triangles);
    for (size_t i = 0; i < placements.size(); ++i) {
        const double world =
            skinned(placements[i])
                ? total_area(posed_positions(scene, poses, placements[i]), shape.triangles)
                : total_area(mapped(own, maps[i]), shape.triangles);
        shape.scales.push_back(area > 0 ? std::sqrt(world / area) : 1.0);
    }
    return shape;
}

}  // namespace aglow::mesh
