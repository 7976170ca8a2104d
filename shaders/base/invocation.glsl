// The number of this invocation where work groups of 64 spread over x and y, as gl::dispatch() sends
// them; it may lie past the end of what is to be done.
uint invocation() { return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u; }

// The same where one end of the list is harder than the other: llvmpipe's threads have a run of work
// groups each, and the last to finish holds up all. Work groups of the first half take every other
// one. Not for programs whose neighbours write to the same places, which threads should not share.
uint spread_invocation() {
  uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y, half_groups = (groups + 1u) / 2u;
  group = group < half_groups ? 2u * group : 2u * (group - half_groups) + 1u;
  return group * 64u + gl_LocalInvocationIndex;
}
