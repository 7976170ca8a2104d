// The number of this invocation where work groups of 64 spread over x and y, as gl::dispatch() sends
// them; it may lie past the end of what is to be done.
uint invocation() { return gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u; }
