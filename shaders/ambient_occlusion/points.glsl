// Estimators that look at points of the hemisphere one by one. Directions follow the cosine; distances
// are spread evenly over the volume up to r_max, since what a direction meets on its way is mostly
// told by the points far out. The estimator's point_occlusion() says what each point counts.
//
// Where the paper counts the range of occluders from the surface, it is counted from the point here:
// what is recorded within r_max of the point stands in its way, unless it is much farther from the
// surface than the point can be; what is nearer to the view is another thing that hides it. The
// latter, and what hides the surface itself, leave the point unknown.

void estimate(Place p, Face face, uint first, uint count, inout Sums sums) {
  vec3 x, y;
  frame_around(p.normal, x, y);
  for (uint i = first; i < first + count; ++i) {
    vec3 u = sequence_point(p, i);
    vec3 direction = cosine_direction(u.xy, x, y, p.normal);
    vec3 offset = direction * (pow(u.z, 1.0 / 3.0) * r_max());
    Look l = look(face, p.position, offset);
    float rise = elevation(l, p.normal);
    bool near = l.seen && rise > 0.0 && within(l.surface - offset, 1.0) && within(l.surface, 1.5);
    bool blocked = near && l.hidden;
    sums.occlusion += near ? point_occlusion(rise, blocked) : 0.0;
    sums.hidden += l.seen && !l.hidden ? 0.0 : 1.0;
    sums.unknown += l.seen && (!l.hidden || blocked) ? 0.0 : 1.0;
#if IMPORTANCE
    sums.distances += l.seen ? min(length(l.surface) * occlusion.range.y, 1.0) : 1.0;
#endif
    sums.closed += blocked ? direction : vec3(0.0);
  }
  sums.count += float(count);
}
