// The surfaces where paths end, which are lit.
#include "base/bsdf.glsl"
#include "specular_rays/path.glsl"
#include "tracing/surface_record.glsl"

layout(binding = 8) uniform usamplerBuffer records;

struct EndSurface {
  vec3 position;  // about the list of triangles
  float bulge;    // Hit::bulge
  Lobes lobes;
};

Lobes fetch_lobes(uint i, vec3 view) {
  uvec4 texels[LOBES_TEXELS];
  for (int k = 0; k < LOBES_TEXELS; ++k)
    texels[k] = texelFetch(records, int(i) * SURFACE_TEXELS + LOBES_AT + k);
  return unpack_lobes(texels, view);
}

// Leaves out the lobes of FOLLOWS bits.
void remove_lobes(inout Lobes l, uint which) {
#if GLOSSY
  if ((which & FOLLOWS_SPECULAR) != 0u) l.specular = l.grazing = vec3(0.0);
#if LAYERS
  if ((which & FOLLOWS_COAT) != 0u) l.coat = 0.0;
#endif
#endif
#if TRANSMISSION
  if ((which & FOLLOWS_TRANSMISSION) != 0u) l.transmission = vec3(0.0);
#endif
}

EndSurface fetch_end(uint i) {
  EndSurface end;
  end.position = uintBitsToFloat(texelFetch(records, int(i) * SURFACE_TEXELS).xyz);
  end.bulge = uintBitsToFloat(texelFetch(records, int(i) * SURFACE_TEXELS + 1).y);
  end.lobes = fetch_lobes(i, -fetch_direction(i));
  return end;
}
