// Whether a triangle, by its edge functions, may reach into a square.

// Half a cell and a margin for rounding, in cells: one for all passes, which must agree.
const float REACH = 0.52;

// The functions are not negative inside, dot(edge, (x, y, 1)); `slack` is how far rounding may put
// each off. Of a triangle that is `edge_on`, thin as seen here, the orientation is not known.
bool edges_reach(vec3 edge0, vec3 edge1, vec3 edge2, vec3 slack, bool edge_on, vec2 centre,
                 float half_size) {
  vec3 at = vec3(centre, 1.0);
  vec3 e = vec3(dot(edge0, at), dot(edge1, at), dot(edge2, at));
  vec3 reach = half_size * vec3(abs(edge0.x) + abs(edge0.y), abs(edge1.x) + abs(edge1.y),
                                abs(edge2.x) + abs(edge2.y)) + slack;
  return all(greaterThanEqual(e, -reach)) || (edge_on && all(lessThanEqual(e, reach)));
}
