// Which sides of surfels rays have met: light of the others would arrive nowhere.
layout(binding = MET_SIDES_UNIT) uniform usamplerBuffer met_sides;  // front, back

bool is_met(uint side) { return texelFetch(met_sides, int(side)).x != 0u; }
