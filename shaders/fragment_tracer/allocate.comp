// Gives the list of each invocation a run.
#include "fragment_tracer/lists.glsl"

void main() {
  uint list = invocation();
  if (list >= count || counts[list] == 0u) return;
  firsts[list] = atomicAdd(counters.placed, counts[list]);
  atomicMax(counters.longest, counts[list]);
  atomicAdd(counters.used, 1u);
}
