// traverse() of native/tracing/tracer.h for structures of views: view by view, in each from cell to cell, and through the
// lists of cells. Whoever includes it has
//
//     bool next_view(inout Traversal at);   enters the next view; false when none is left
//     void step_cell(inout Traversal at);   one cell, while at.alive; sets at.listing where its list is to be tested
//     void step_list(Ray ray, inout Traversal at, inout TracedHit hit);   one entry, while at.listing
bool traverse(Ray ray, inout Traversal at, inout TracedHit hit, int budget) {
  bool left = true;
  while (left && budget > 0) {
    // A loop of no or one turn, since software skips that where no ray at hand needs it.
    for (int turn = at.alive || at.listing ? 1 : 0; turn < 1; ++turn) {
      left = next_view(at);
      --budget;
    }
    while (at.alive && !at.listing && budget > 0) {
      step_cell(at);
      --budget;
    }
    while (at.listing && budget > 0) {
      step_list(ray, at, hit);
      --budget;
#if ANY_HIT
      if (hit.primitive != NO_PRIMITIVE) return true;
#endif
    }
  }
  return !left;
}
