// What lamps emit away from their axis: measured in Cycles 3.4.

// The cone's smooth step times the cosine, as of a disk square to the axis. cone: cosine of the half
// angle, 1 / width of the blend in cosines.
float spot_falloff(vec2 cone, float cosine) {
  if (cosine <= cone.x) return 0.0;
  float t = clamp((cosine - cone.x) * cone.y, 0.0, 1.0);
  return cosine * t * t * (3.0 - 2.0 * t);
}

// One-sided Lambertian emitter, times the cosine. spread: tan(spread / 2), below 0 for none, and the
// factor that keeps the power.
float area_falloff(vec2 spread, float cosine) {
  if (cosine <= 0.0) return 0.0;
  if (spread.x < 0.0) return cosine;
  float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
  return cosine * max(spread.x - tangent, 0.0) * spread.y;
}
