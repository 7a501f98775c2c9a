// SPDX-License-Identifier: Apache-2.0
// What every shader that draws starts with. Each stage then declares
//   layout(push_constant, scalar) uniform Push { SomeArgs args; };
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "aglow/shared/buffers.h"
