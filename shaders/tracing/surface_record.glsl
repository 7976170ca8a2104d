// How a surface that a ray has met is stored, after base/lobes.glsl: a texel {position about the list
// of triangles, metres; how far off the surface rays begin, metres}, one {number of the ray;
// Hit::bulge, metres}, its emission where anything emits, its lobes.
// rasterize::GBufferOptions::record_bytes() knows the size.

#if EMISSION
const int LOBES_AT = 3;
#else
const int LOBES_AT = 2;
#endif
const int SURFACE_TEXELS = LOBES_AT + LOBES_TEXELS;

// Of the coordinates at hand: 32 steps of a float, where the position of a hit is good to about 4.
const float RAY_OFFSET = 3.8e-6;
