// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/result.h"
#include "aglow/scene/scene.h"

#include <filesystem>

namespace aglow {

/// Loads a Wavefront OBJ with the MTL files it names. Every object (or group, where the file has
/// no objects) becomes a mesh with a node of its own and one primitive per material. Kd becomes
/// base colour (metallic 0), Ke luminance in cd/m^2, map_Kd and map_Ke textures, d or Tr below 1
/// alpha blending. Polygons are triangulated; faces without normals are flat.
/// Result  coordinates as they stand in the file, taken as metres with +Y up. A missing MTL file,
///         material or texture is a warning of the scene.
/// Errors  unreadable  the OBJ cannot be read
///         malformed   a face names a vertex that does not exist, a number is not finite, or there
///                     is no face at all; the message names the face or vertex, counted from 1
///         out_of_memory
/// Cost    O(size of the files), and O(n^2) per polygon of n corners.
Result<Scene> load_obj(const std::filesystem::path& path);

}  // namespace aglow
