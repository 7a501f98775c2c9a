// SPDX-License-Identifier: Apache-2.0
#pragma once

// The whole way from a file to its light and to a picture. Each stage also stands alone.
#include "aglow/bake/bake.h"         // IWYU pragma: export
#include "aglow/encode/lit_gltf.h"   // IWYU pragma: export
#include "aglow/render/camera.h"     // IWYU pragma: export
#include "aglow/render/rays.h"       // IWYU pragma: export
#include "aglow/render/tone_map.h"   // IWYU pragma: export
#include "aglow/scene/builtin.h"     // IWYU pragma: export
#include "aglow/scene/image_file.h"  // IWYU pragma: export
#include "aglow/scene/load.h"        // IWYU pragma: export
#include "aglow/scene/write.h"       // IWYU pragma: export
