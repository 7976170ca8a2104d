// The number of this invocation where work groups of 64 spread over x and y, as gl::dispatch() sends
// them; it may lie past the end of what is to be done.
uint invocation() { return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u; }

// The same where parts of the list are harder than others: llvmpipe's threads have a half (or so) of
// the work groups each, and the last to finish holds up all. Runs of `run` work groups, a power of
// two, change places so that runs of the first half take every other one. Programs whose neighbours
// write to the same places want long runs, since threads should not share these.
uint spread_invocation(uint run) {
  uint group = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  uint half_runs = gl_NumWorkGroups.x * gl_NumWorkGroups.y / (2u * run), at = group / run;
  if (at < 2u * half_runs) at = at < half_runs ? 2u * at : 2u * (at - half_runs) + 1u;
  return (at * run + group % run) * 64u + gl_LocalInvocationIndex;
}
