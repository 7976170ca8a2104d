// The surface that receives light, relative to the camera.
struct Receiver {
  vec3 position;
  vec3 geometric_normal, smooth_normal;  // unit, on the viewer's side
  float bulge;                           // Hit::bulge
  float random;                          // 0..1, turns the pattern of taps
};
