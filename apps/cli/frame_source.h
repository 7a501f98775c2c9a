// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/render/frames.h"
#include "aglow/render/raster.h"
#include "console.h"

#include <memory>

namespace aglow::cli {

/// Engine `rays` on the device that was asked for. A GPU that was asked for by name has to be
/// there; --device auto takes one of hardware where there is one. A GPU that fails while it draws
/// is left with a warning, and the CPU goes on.
/// Errors  of the makers; bad_argument where `accel` is set and the CPU draws.
Result<std::unique_ptr<FrameRenderer>> rays_renderer(const Footage& footage, Accel accel,
                                                     Console& console);

/// Engine `raster`, on a GPU of any kind where none is asked for by name.
/// Errors  of the maker; unsupported where there is no GPU, or --device cpu.
Result<std::unique_ptr<FrameRenderer>> raster_renderer(const Footage& footage,
                                                       const RasterOptions& options,
                                                       Console& console);

/// Engine `path` on the CPU.
std::unique_ptr<FrameRenderer> path_renderer(const Scene& scene, int bounces, int samples,
                                             uint64_t seed);

}  // namespace aglow::cli
