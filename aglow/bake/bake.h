// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/core/progress.h"
#include "aglow/core/result.h"
#include "aglow/encode/lightmap.h"
#include "aglow/mesh/surfaces.h"
#include "aglow/mesh/texels.h"
#include "aglow/mesh/unwrap.h"
#include "aglow/scene/scene.h"
#include "aglow/transport/irradiance.h"

#include <filesystem>
#include <span>
#include <vector>

namespace aglow {

enum class Method : uint8_t { gather, path };
enum class Quality : uint8_t { draft, medium, high };

/// What every solver needs to know, whether it lights texels or sensors.
struct SolveOptions {
    Method method = Method::gather;
    Quality quality = Quality::medium;
    int samples = 0;  ///< > 0: exactly so many per texel or sensor, instead of `quality`
    int bounces = kConverged;
    double time = -1;  ///< s; negative: the rest pose
    uint64_t seed = 0;
};

struct BakeOptions {
    SolveOptions solve;
    UnwrapOptions unwrap;
};

struct Seconds {
    double unwrap = 0, solve = 0, encode = 0;
};

/// A lit scene, ready to be written or drawn.
struct Baked {
    Scene scene;  ///< with lightmap UVs
    Surfaces surfaces;
    Atlas atlas;
    Texels texels;
    IrradianceField field;  ///< per texel
    Lightmap lightmap;
    Seconds seconds;
};

/// The whole way from a scene to its light: unwrap, pose, trace, solve, encode.
/// Errors  of the stages; bad_argument where the scene has no triangles.
Result<Baked> bake(Scene scene, const BakeOptions& options, const Monitor& monitor = {});

/// Illuminance at free sensors, in their order. The gather solver first lights the scene's texels
/// at `options.unwrap`, then gathers at the sensors; the path solver traces from the sensors alone.
Result<IrradianceField> measure(Scene scene, std::span<const Receiver> sensors,
                                const BakeOptions& options, const Monitor& monitor = {});

/// Sensors on the upward faces of a scene (geometric normal within 45 degrees of +Y), on a
/// horizontal grid of `spacing` metres (points at odd multiples of half the spacing); they lie on
/// the surface, face along its normal, and are in order of part, row, column.
std::vector<Receiver> grid_sensors(const Scene& scene, float spacing, double time = -1);

}  // namespace aglow
