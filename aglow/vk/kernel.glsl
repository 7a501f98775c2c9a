// SPDX-License-Identifier: Apache-2.0
// What every compute shader starts with. A shader then declares
//   layout(local_size_x = N) in;
//   layout(push_constant, scalar) uniform Push { SomeArgs args; };  // uint first_group comes first
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "aglow/shared/buffers.h"

// Which of a dispatch's groups this is; dispatches may run in pieces.
#define group_index() (args.first_group + gl_WorkGroupID.x)
// Which of a dispatch's invocations this is.
#define global_index() (group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x)
