// SPDX-License-Identifier: Apache-2.0
// Rays against everything in a TraceScene, whatever structures it is made of.
//
//   RayHit intersect(TraceScenePtr scene, RayQuery ray)   the nearest hit
//   bool occluded(TraceScenePtr scene, RayQuery ray)      whether anything is hit
//
// Before it includes this file, a shader may define
//   #define AG_ACCEPT_HIT(triangle, barycentrics, t) ...  a bool: false lets the ray pass, for
//                                                         triangles whose texture has holes
//   #define AG_KINDS k                                    which kinds may occur, a constant with
//                                                         bit 1 << kStructure... set for each
//   #define AG_COUNT_STEPS / AG_COUNT_TRIANGLES           statements that count work
// Each kind brings, in accel/gpu/<kind>.glsl, with the ray in the structure's space,
//   void trace_<kind>(uvec2 header, uint first_triangle, RayQuery ray, bool any, inout RayHit hit)
// which lowers hit to the nearest accepted triangle with ray.near < t < hit.t, or returns at the
// first one where `any` is true.
