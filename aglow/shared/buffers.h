// SPDX-License-Identifier: Apache-2.0
// Device addresses of arrays of the basic types.
#ifndef AGLOW_SHARED_BUFFERS_H
#define AGLOW_SHARED_BUFFERS_H
#include "aglow/shared/glsl.h"
AG_NAMESPACE_BEGIN

AG_BUFFER_OF(uint);
AG_BUFFER_OF(float);
AG_BUFFER_OF(vec2);
AG_BUFFER_OF(vec3);
AG_BUFFER_OF(vec4);
AG_BUFFER_OF(uvec2);
AG_BUFFER_OF(uvec3);
AG_BUFFER_OF(uvec4);

AG_NAMESPACE_END
#endif
