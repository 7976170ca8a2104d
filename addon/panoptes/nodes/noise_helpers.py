# SPDX-License-Identifier: GPL-3.0-or-later
"""GLSL of noises: hashes, Perlin's gradient noise, its fractal sums, Magic and Brick.

Places are vec4 of which `d` components count, 1 to 4; d is a constant wherever these are called, so
that the compiler keeps one dimension's code. Numbers are those of Blender: the same hash of the same
bits, the same gradients and scales.
"""

from .helpers import add

# Bob Jenkins' lookup3 (public domain), for up to four words.
add('noise_hash', '''
uint noise_rotate(uint x, int k) { return (x << k) | (x >> (32 - k)); }
uint noise_hash(uvec4 k, int words)
{
    uint a = 0xdeadbeefu + uint(words * 4) + 13u, b = a, c = a;
    a += k.x;
    if (words > 1)
        b += k.y;
    if (words > 2)
        c += k.z;
    if (words > 3) {
        a -= c; a ^= noise_rotate(c, 4); c += b;
        b -= a; b ^= noise_rotate(a, 6); a += c;
        c -= b; c ^= noise_rotate(b, 8); b += a;
        a -= c; a ^= noise_rotate(c, 16); c += b;
        b -= a; b ^= noise_rotate(a, 19); a += c;
        c -= b; c ^= noise_rotate(b, 4); b += a;
        a += k.w;
    }
    c ^= b; c -= noise_rotate(b, 14);
    a ^= c; a -= noise_rotate(c, 11);
    b ^= a; b -= noise_rotate(a, 25);
    c ^= b; c -= noise_rotate(b, 16);
    a ^= c; a -= noise_rotate(c, 4);
    b ^= a; b -= noise_rotate(a, 14);
    c ^= b; c -= noise_rotate(b, 24);
    return c;
}
float noise_random(vec4 p, int words)
{
    return float(noise_hash(floatBitsToUint(p), words)) / 4294967295.0;
}
// Random numbers of a place: as many as it has components, and a colour.
vec4 noise_random_place(vec4 p, int d)
{
    if (d == 1)
        return vec4(noise_random(p, 1), 0.0, 0.0, 0.0);
    if (d == 2)
        return vec4(noise_random(p, 2), noise_random(vec4(p.xy, 1.0, 0.0), 3), 0.0, 0.0);
    if (d == 3)
        return vec4(noise_random(p, 3), noise_random(vec4(p.xyz, 1.0), 4),
                    noise_random(vec4(p.xyz, 2.0), 4), 0.0);
    return vec4(noise_random(p, 4), noise_random(p.wxyz, 4), noise_random(p.zwxy, 4),
                noise_random(p.yzwx, 4));
}
vec3 noise_random_color(vec4 p, int d)
{
    if (d == 1)
        return vec3(noise_random(p, 1), noise_random(vec4(p.x, 1.0, 0.0, 0.0), 2),
                    noise_random(vec4(p.x, 2.0, 0.0, 0.0), 2));
    if (d == 2)
        return vec3(noise_random(p, 2), noise_random(vec4(p.xy, 1.0, 0.0), 3),
                    noise_random(vec4(p.xy, 2.0, 0.0), 3));
    if (d == 3)
        return noise_random_place(p, 3).xyz;
    return vec3(noise_random(p, 4), noise_random(p.zxwy, 4), noise_random(p.wzyx, 4));
}
// A far place, another one for each seed, where noise is independent.
vec4 noise_offset(float seed, int d)
{
    if (d == 1)
        return vec4(100.0 + 100.0 * noise_random(vec4(seed), 1), 0.0, 0.0, 0.0);
    vec4 result = vec4(0.0);
    for (int i = 0; i < d; ++i)
        result[i] = 100.0 + 100.0 * noise_random(vec4(seed, float(i), 0.0, 0.0), 2);
    return result;
}
''')
add('noise_perlin', '''
float noise_gradient(uint h, vec4 f, int d)
{
    if (d == 1) {
        float slope = 1.0 + float(h & 7u);
        return ((h & 8u) != 0u ? -slope : slope) * f.x;
    }
    float u, v, s = 0.0;
    if (d == 2) {
        bool low = (h & 7u) < 4u;
        u = low ? f.x : f.y;
        v = 2.0 * (low ? f.y : f.x);
    } else if (d == 3) {
        h &= 15u;
        u = h < 8u ? f.x : f.y;
        v = h < 4u ? f.y : (h == 12u || h == 14u ? f.x : f.z);
    } else {
        h &= 31u;
        u = h < 24u ? f.x : f.y;
        v = h < 16u ? f.y : f.z;
        s = h < 8u ? f.z : f.w;
    }
    return ((h & 1u) != 0u ? -u : u) + ((h & 2u) != 0u ? -v : v) + ((h & 4u) != 0u ? -s : s);
}
// Perlin's improved gradient noise, -1..1 or nearly.
float noise_perlin(vec4 p, int d)
{
    vec4 cell = floor(p);
    vec4 f = p - cell;
    vec4 fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    float sum = 0.0;
    for (int corner = 0; corner < (1 << d); ++corner) {
        vec4 at = vec4(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1, (corner >> 3) & 1);
        vec4 share = mix(1.0 - fade, fade, at);
        float weight = share.x;
        for (int i = 1; i < d; ++i)
            weight *= share[i];
        sum += weight * noise_gradient(noise_hash(uvec4(ivec4(cell + at)), d), f - at, d);
    }
    return sum * vec4(0.25, 0.6616, 0.982, 0.8344)[d - 1];
}
''', 'noise_hash')
add('noise_fractal', '''
// Octaves of noise, each twice as fine (or `lacunarity` times); 0..1.
float noise_fractal(vec4 p, int d, float detail, float roughness, float lacunarity)
{
    float octaves = clamp(detail, 0.0, 15.0);
    int last = int(octaves);
    float amplitude = 1.0, total = 0.0, sum = 0.0, scale = 1.0;
    for (int i = 0; i <= last; ++i) {
        sum += amplitude * (0.5 * noise_perlin(scale * p, d) + 0.5);
        total += amplitude;
        amplitude *= clamp(roughness, 0.0, 1.0);
        scale *= lacunarity;
    }
    float rest = octaves - floor(octaves);
    if (rest == 0.0)
        return sum / total;
    float more = sum + amplitude * (0.5 * noise_perlin(scale * p, d) + 0.5);
    return mix(sum / total, more / (total + amplitude), rest);
}
vec4 noise_distorted(vec4 p, int d, float distortion)
{
    vec4 moved = p;
    if (distortion != 0.0)
        for (int i = 0; i < d; ++i)
            moved[i] += distortion * noise_perlin(p + noise_offset(float(i), d), d);
    return moved;
}
vec3 noise_fractal_color(vec4 p, int d, float detail, float roughness, float lacunarity)
{
    return vec3(noise_fractal(p, d, detail, roughness, lacunarity),
                noise_fractal(p + noise_offset(float(d), d), d, detail, roughness, lacunarity),
                noise_fractal(p + noise_offset(float(d + 1), d), d, detail, roughness, lacunarity));
}
''', 'noise_perlin')
add('noise_musgrave', '''
const int MUSGRAVE_FBM = 0, MUSGRAVE_MULTIFRACTAL = 1, MUSGRAVE_HETERO_TERRAIN = 2;
const int MUSGRAVE_HYBRID_MULTIFRACTAL = 3, MUSGRAVE_RIDGED_MULTIFRACTAL = 4;
// Musgrave's fractals (Ebert et al., Texturing and Modeling).
float noise_musgrave(int kind, vec4 p, int d, float detail, float dimension, float lacunarity,
                     float offset, float gain)
{
    lacunarity = max(lacunarity, 1e-5);
    float octaves = clamp(detail, 0.0, 15.0), fall = pow(lacunarity, -max(dimension, 1e-5));
    float rest = octaves - floor(octaves);
    int count = int(octaves);
    float power = 1.0;
    if (kind == MUSGRAVE_FBM || kind == MUSGRAVE_MULTIFRACTAL) {
        float sum = 0.0, product = 1.0;
        // The last, partial octave counts by its share.
        for (int i = 0; i <= count; ++i) {
            float share = i < count ? 1.0 : rest;
            float octave = share != 0.0 ? share * power * noise_perlin(p, d) : 0.0;
            sum += octave;
            product *= octave + 1.0;
            power *= fall;
            p *= lacunarity;
        }
        return kind == MUSGRAVE_FBM ? sum : product;
    }
    if (kind == MUSGRAVE_RIDGED_MULTIFRACTAL) {
        float ridge = offset - abs(noise_perlin(p, d));
        ridge *= ridge;
        float sum = ridge;
        for (int i = 1; i < count; ++i) {
            p *= lacunarity;
            power *= fall;
            float weight = clamp(ridge * gain, 0.0, 1.0);
            ridge = offset - abs(noise_perlin(p, d));
            ridge *= ridge * weight;
            sum += ridge * power;
        }
        return sum;
    }
    float value = noise_perlin(p, d) + offset;
    float weight = gain * value;
    for (int i = 1; i <= max(count, 1); ++i) {
        float share = i < count ? 1.0 : rest;
        p *= lacunarity;
        power *= fall;
        if (share == 0.0 || (kind == MUSGRAVE_HYBRID_MULTIFRACTAL && weight <= 0.001))
            break;
        float octave = (noise_perlin(p, d) + offset) * power;
        if (kind == MUSGRAVE_HETERO_TERRAIN) {
            value += share * octave * value;
        } else {
            weight = min(weight, 1.0);
            value += share * weight * octave;
            weight *= gain * octave;
        }
    }
    return value;
}
''', 'noise_perlin')
add('noise_magic', '''
vec3 noise_magic(vec3 p, int depth, float distortion)
{
    p *= 5.0;
    vec3 v = vec3(sin(p.x + p.y + p.z), cos(-p.x + p.y - p.z), -cos(-p.x - p.y + p.z));
    // Each turn bends one component by the others.
    for (int i = 0; i < depth; ++i) {
        if (i == 0) { v *= distortion; v.y = -cos(v.x - v.y + v.z) * distortion; }
        if (i == 1) v.x = cos(v.x - v.y - v.z) * distortion;
        if (i == 2) v.z = sin(-v.x - v.y - v.z) * distortion;
        if (i == 3) v.x = -cos(-v.x + v.y - v.z) * distortion;
        if (i == 4) v.y = -sin(-v.x + v.y + v.z) * distortion;
        if (i == 5) v.y = -cos(-v.x + v.y + v.z) * distortion;
        if (i == 6) v.x = cos(v.x + v.y + v.z) * distortion;
        if (i == 7) v.z = sin(v.x + v.y - v.z) * distortion;
        if (i == 8) v.x = -cos(-v.x - v.y + v.z) * distortion;
        if (i == 9) v.y = -sin(v.x - v.y + v.z) * distortion;
    }
    if (distortion != 0.0)
        v /= 2.0 * distortion;
    return 0.5 - v;
}
''')
add('noise_brick', '''
// x: which of two colours, y: how much mortar.
vec2 noise_brick(vec3 p, float mortar, float smoothness, float bias, float width, float height,
                 float offset, int offset_rows, float squash, int squash_rows)
{
    float row = floor(node_divide(p.y, height));
    float shift = 0.0;
    if (offset_rows != 0 && squash_rows != 0) {
        width *= int(row) % squash_rows != 0 ? 1.0 : squash;
        shift = int(row) % offset_rows != 0 ? 0.0 : width * offset;
    }
    float brick = floor(node_divide(p.x + shift, width));
    vec2 inside = vec2(p.x + shift - width * brick, p.y - height * row);
    // A random number of the brick, as Perlin's first noises had it.
    uint n = (uint(int(row) << 16) + (uint(int(brick)) & 0xffffu) + 1013u) & 0x7fffffffu;
    n = (n >> 13) ^ n;
    n = (n * (n * n * 60493u + 19990303u) + 1376312589u) & 0x7fffffffu;
    float tint = clamp(0.5 * float(n) / 1073741824.0 + bias, 0.0, 1.0);
    float edge = min(min(inside.x, inside.y), min(width - inside.x, height - inside.y));
    if (edge >= mortar)
        return vec2(tint, 0.0);
    if (smoothness == 0.0)
        return vec2(tint, 1.0);
    edge = 1.0 - edge / mortar;
    return vec2(tint, edge < smoothness ? smoothstep(0.0, 1.0, edge / smoothness) : 1.0);
}
''', 'node_divide')
