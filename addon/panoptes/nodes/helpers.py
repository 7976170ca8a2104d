# SPDX-License-Identifier: GPL-3.0-or-later
"""GLSL functions for nodes whose arithmetic is more than an expression.

Each is guarded by a macro, so that any number of generated shaders may meet in one program. They
follow what the nodes do in Cycles, including its answers where the mathematics has none (a division
by zero gives 0).
"""

_FUNCTIONS = {}


def add(name, source, *needs):
    """Offer a function (or several that belong together) under a name; `needs` are the names it calls."""
    _FUNCTIONS[name] = (source.strip(), needs)


def require(chosen, name):
    """Append `name` and what it calls to the list `chosen`, callees first, each once."""
    if name in chosen:
        return
    for needed in _FUNCTIONS[name][1]:
        require(chosen, needed)
    chosen.append(name)


def source(names):
    """Return the guarded GLSL of these helpers."""
    parts = []
    for name in names:
        guard = f'PANOPTES_{name.upper()}'
        parts.append(f'#ifndef {guard}\n#define {guard}\n{_FUNCTIONS[name][0]}\n#endif\n')
    return ''.join(parts)


add('node_divide', '''
float node_divide(float a, float b) { return b != 0.0 ? a / b : 0.0; }
vec3 node_divide(vec3 a, vec3 b)
{
    return vec3(node_divide(a.x, b.x), node_divide(a.y, b.y), node_divide(a.z, b.z));
}
''')
add('node_power', '''
float node_power(float a, float b)
{
    if (b == 0.0)
        return 1.0;
    if (a == 0.0)
        return 0.0;
    float whole = floor(b);
    if (a > 0.0)
        return pow(a, b);
    if (whole != b)
        return 0.0;
    float magnitude = pow(-a, b);
    return mod(whole, 2.0) == 0.0 ? magnitude : -magnitude;
}
''')
add('node_logarithm', '''
float node_logarithm(float a, float base)
{
    if (a <= 0.0 || base <= 0.0)
        return 0.0;
    float scale = log(base);
    return scale != 0.0 ? log(a) / scale : 0.0;
}
''')
add('node_modulo', '''
float node_modulo(float a, float b) { return b != 0.0 ? a - b * trunc(a / b) : 0.0; }
''')
add('node_floored_modulo', '''
float node_floored_modulo(float a, float b) { return b != 0.0 ? a - b * floor(a / b) : 0.0; }
''')
add('node_wrap', '''
float node_wrap(float a, float high, float low)
{
    float range = high - low;
    return range != 0.0 ? a - range * floor((a - low) / range) : low;
}
''')
add('node_ping_pong', '''
float node_ping_pong(float a, float scale)
{
    if (scale == 0.0)
        return 0.0;
    return abs(fract((a - scale) / (scale * 2.0)) * scale * 2.0 - scale);
}
''')
add('node_smooth_minimum', '''
float node_smooth_minimum(float a, float b, float width)
{
    if (width == 0.0)
        return min(a, b);
    float h = max(width - abs(a - b), 0.0) / width;
    return min(a, b) - h * h * h * width * (1.0 / 6.0);
}
''')
add('node_safe_normalize', '''
vec3 node_safe_normalize(vec3 v)
{
    float size = length(v);
    return size != 0.0 ? v / size : vec3(0.0);
}
''')
add('node_project', '''
vec3 node_project(vec3 a, vec3 b)
{
    float size = dot(b, b);
    return size != 0.0 ? dot(a, b) / size * b : vec3(0.0);
}
''')
add('node_euler', '''
mat3 node_euler(vec3 angle)
{
    vec3 c = cos(angle);
    vec3 s = sin(angle);
    mat3 x = mat3(1.0, 0.0, 0.0, 0.0, c.x, s.x, 0.0, -s.x, c.x);
    mat3 y = mat3(c.y, 0.0, -s.y, 0.0, 1.0, 0.0, s.y, 0.0, c.y);
    mat3 z = mat3(c.z, s.z, 0.0, -s.z, c.z, 0.0, 0.0, 0.0, 1.0);
    return z * y * x;
}
''')
add('node_checker', '''
float node_checker(vec3 p)
{
    // A plane that lies exactly on the cell borders must not flicker between the two colours.
    ivec3 cell = abs(ivec3(floor((p + 0.000001) * 0.999999)));
    ivec3 odd = cell & 1;
    return ((odd.x == odd.y) == (odd.z != 0)) ? 1.0 : 0.0;
}
''')
add('node_table', '''
vec4 node_table(int first, int last, float position, bool interpolate)
{
    float place = clamp(position, 0.0, 1.0) * float(last);
    int low = clamp(int(place), 0, last);
    vec4 value = param(first + low);
    if (!interpolate)
        return value;
    return mix(value, param(first + min(low + 1, last)), place - float(low));
}
''')
add('node_extended_table', '''
// Goes on in a straight line beyond both ends.
vec4 node_extended_table(int first, int last, float position, bool interpolate)
{
    vec4 value = node_table(first, last, position, interpolate);
    if (position < 0.0)
        return value + (param(first + 1) - value) * (position * float(last));
    if (position > 1.0)
        return value + (value - param(first + last - 1)) * ((position - 1.0) * float(last));
    return value;
}
''', 'node_table')
add('node_rotate', '''
vec3 node_rotate(vec3 v, vec3 axis, float angle)
{
    float size = length(axis);
    if (size == 0.0)
        return v;
    axis /= size;
    float c = cos(angle);
    return v * c + cross(axis, v) * sin(angle) + axis * dot(axis, v) * (1.0 - c);
}
''')

# Spaces. `point` is 1 for places and 0 for directions.
add('node_object_to_world', '''
vec3 node_object_to_world(Hit hit, vec3 v, float point)
{
    Transform t = fetch_transform(hit.instance, vec3(0.0));
    return t.linear * v + t.translation * point;
}
''')
add('node_world_to_object', '''
vec3 node_world_to_object(Hit hit, vec3 v, float point)
{
    Transform t = fetch_transform(hit.instance, vec3(0.0));
    float determinant = dot(t.linear[0], cross(t.linear[1], t.linear[2]));
    if (determinant == 0.0)
        return vec3(0.0);
    return transpose(cofactors(t.linear)) * (v - t.translation * point) / determinant;
}
''')
add('node_camera_axes', '''
// To the right, upwards and forwards.
mat3 node_camera_axes()
{
    vec3 forwards = view.axis.xyz;
    bool perspective = view.filtering.z > 0.5;
    vec3 right = perspective ? view.ray_direction_dx.xyz : view.ray_origin_dx.xyz;
    right = normalize(right - forwards * dot(right, forwards));
    return mat3(right, cross(right, forwards), forwards);
}
''')
add('node_to_camera', '''
vec3 node_to_camera(vec3 v, float point)
{
    return transpose(node_camera_axes()) * (v - view.world_origin.xyz * point);
}
''', 'node_camera_axes')
add('node_from_camera', '''
vec3 node_from_camera(vec3 v, float point)
{
    return node_camera_axes() * v + view.world_origin.xyz * point;
}
''', 'node_camera_axes')
add('node_window', '''
vec3 node_window(vec3 v, float point)
{
    vec4 clip = view.clip_from_relative * vec4(v - view.world_origin.xyz * point, 1.0);
    return vec3(clip.xy / clip.w * 0.5 + 0.5, 0.0);
}
''')
add('node_equirectangular', '''
vec2 node_equirectangular(vec3 direction)
{
    float u = -atan(direction.y, direction.x) * 0.15915494 + 0.5;
    return vec2(u, atan(direction.z, length(direction.xy)) * 0.31830989 + 0.5);
}
''')
add('node_mirror_ball', '''
vec2 node_mirror_ball(vec3 direction)
{
    // Where a mirroring ball seen along +Y shows this direction.
    direction = node_safe_normalize(direction);
    vec3 halfway = direction - vec3(0.0, 1.0, 0.0);
    float size = 2.0 * sqrt(max(-0.5 * halfway.y, 0.0));
    if (size > 0.0)
        halfway /= size;
    return halfway.xz * 0.5 + 0.5;
}
''', 'node_safe_normalize')
add('node_box_weights', '''
// How much each axis' projection shows on a surface of this normal: its own where one component
// stands out by more than the blend, a mix of two near an edge and of three near a corner.
vec3 node_box_weights(vec3 normal, float blend)
{
    vec3 n = abs(normal) / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    float limit = 0.5 * (1.0 + blend);
    vec3 pairs = n.yzx / (n.yzx + n.zxy); // y against z, z against x, x against y
    vec3 others = 1.0 - pairs;
    if (n.x > limit * (n.x + n.y) && n.x > limit * (n.x + n.z))
        return vec3(1.0, 0.0, 0.0);
    if (n.y > limit * (n.x + n.y) && n.y > limit * (n.y + n.z))
        return vec3(0.0, 1.0, 0.0);
    if (n.z > limit * (n.x + n.z) && n.z > limit * (n.y + n.z))
        return vec3(0.0, 0.0, 1.0);
    if (blend <= 0.0)
        return vec3(1.0, 0.0, 0.0);
    vec3 mixed = clamp((vec3(pairs.z, pairs.x, others.y) - 0.5 * (1.0 - blend)) / blend, 0.0, 1.0);
    if (n.z < (1.0 - limit) * (n.x + n.y))
        return vec3(mixed.x, 1.0 - mixed.x, 0.0);
    if (n.x < (1.0 - limit) * (n.y + n.z))
        return vec3(0.0, mixed.y, 1.0 - mixed.y);
    if (n.y < (1.0 - limit) * (n.x + n.z))
        return vec3(mixed.z, 0.0, 1.0 - mixed.z);
    return ((2.0 - limit) * n + (limit - 1.0)) / (2.0 * limit - 1.0);
}
''')
add('node_sphere_map', '''
vec2 node_sphere_map(vec3 p)
{
    float size = length(p);
    if (size == 0.0)
        return vec2(0.0);
    float u = (p.x == 0.0 && p.y == 0.0) ? 0.0 : (1.0 - atan(p.x, p.y) / 3.14159265) * 0.5;
    return vec2(u, 1.0 - acos(clamp(p.z / size, -1.0, 1.0)) / 3.14159265);
}
''')
add('node_tube_map', '''
vec2 node_tube_map(vec3 p)
{
    float u = (p.x == 0.0 && p.y == 0.0) ? 0.0 : (1.0 - atan(p.x, p.y) / 3.14159265) * 0.5;
    return vec2(u, (p.z + 1.0) * 0.5);
}
''')
