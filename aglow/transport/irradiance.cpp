// SPDX-License-Identifier: Apache-2.0
#include "aglow/transport/irradiance.h"

namespace aglow {

Receiver receiver_at(const Surfaces& surfaces, SurfacePoint at) {
    return {position(surfaces, at), shading_normal(surfaces, at),
            geometric_normal(surfaces, at.triangle), coordinate_magnitude(surfaces, at.triangle)};
}

}  // namespace aglow
