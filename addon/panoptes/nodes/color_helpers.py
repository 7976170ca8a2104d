# SPDX-License-Identifier: GPL-3.0-or-later
"""GLSL functions of the colour nodes: HSV, HSL, gamma and the blend modes, as Cycles has them."""

from .helpers import add

add('node_rgb_to_hsv', '''
vec3 node_rgb_to_hsv(vec3 c)
{
    float high = max(c.r, max(c.g, c.b));
    float range = high - min(c.r, min(c.g, c.b));
    if (range == 0.0 || high == 0.0)
        return vec3(0.0, 0.0, high);
    vec3 distance = (vec3(high) - c) / range;
    float hue;
    if (c.r == high)
        hue = distance.b - distance.g;
    else if (c.g == high)
        hue = 2.0 + distance.r - distance.b;
    else
        hue = 4.0 + distance.g - distance.r;
    return vec3(fract(hue / 6.0), range / high, high);
}
''')
add('node_hue', '''
vec3 node_hue(float hue)
{
    return clamp(abs(fract(vec3(hue) + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
}
''')
add('node_hsv_to_rgb', '''
vec3 node_hsv_to_rgb(vec3 hsv) { return hsv.z * mix(vec3(1.0), node_hue(hsv.x), hsv.y); }
''', 'node_hue')
add('node_rgb_to_hsl', '''
vec3 node_rgb_to_hsl(vec3 c)
{
    float high = max(c.r, max(c.g, c.b));
    float low = min(c.r, min(c.g, c.b));
    float lightness = min(1.0, (high + low) * 0.5);
    if (high == low)
        return vec3(0.0, 0.0, lightness);
    float range = high - low;
    float saturation = lightness > 0.5 ? range / (2.0 - high - low) : range / (high + low);
    return vec3(node_rgb_to_hsv(c).x, saturation, lightness);
}
''', 'node_rgb_to_hsv')
add('node_hsl_to_rgb', '''
vec3 node_hsl_to_rgb(vec3 hsl)
{
    float chroma = (1.0 - abs(2.0 * hsl.z - 1.0)) * hsl.y;
    return (node_hue(hsl.x) - 0.5) * chroma + hsl.z;
}
''', 'node_hue')
add('node_hue_saturation', '''
vec3 node_hue_saturation(vec3 color, float hue, float saturation, float value, float factor)
{
    vec3 hsv = node_rgb_to_hsv(color);
    hsv.x = fract(hsv.x + hue + 0.5);
    hsv.y = clamp(hsv.y * saturation, 0.0, 1.0);
    hsv.z *= value;
    return max(mix(color, node_hsv_to_rgb(hsv), factor), vec3(0.0));
}
''', 'node_rgb_to_hsv', 'node_hsv_to_rgb')
add('node_gamma', '''
vec3 node_gamma(vec3 color, float gamma)
{
    if (gamma == 0.0)
        return vec3(1.0);
    return mix(color, pow(max(color, vec3(1e-30)), vec3(gamma)), greaterThan(color, vec3(0.0)));
}
''')

# Blend modes of the Mix nodes: factor first, then the two colours.
for _name, _body in {
    'burn': '''
    vec3 mixed = vec3(1.0 - f) + f * b;
    vec3 result = clamp(1.0 - (1.0 - a) / mixed, 0.0, 1.0);
    return mix(result, vec3(0.0), lessThanEqual(mixed, vec3(0.0)));
''',
    'dodge': '''
    vec3 rest = 1.0 - f * b;
    vec3 result = min(a / rest, vec3(1.0));
    result = mix(result, vec3(1.0), lessThanEqual(rest, vec3(0.0)));
    return mix(result, vec3(0.0), equal(a, vec3(0.0)));
''',
    'overlay': '''
    vec3 dark = a * (1.0 - f + 2.0 * f * b);
    vec3 light = 1.0 - (1.0 - f + 2.0 * f * (1.0 - b)) * (1.0 - a);
    return mix(light, dark, lessThan(a, vec3(0.5)));
''',
    'soft_light': '''
    vec3 screen = 1.0 - (1.0 - b) * (1.0 - a);
    return (1.0 - f) * a + f * ((1.0 - a) * b * a + a * screen);
''',
    'divide': '''
    vec3 result = (1.0 - f) * a + f * a / b;
    return mix(result, a, equal(b, vec3(0.0)));
''',
}.items():
    add(f'node_blend_{_name}', f'vec3 node_blend_{_name}(float f, vec3 a, vec3 b)\n{{{_body}}}')

for _name, _change in {
    'hue': 'hsv.x = other.x;',
    'color': 'hsv.xy = other.xy;',
}.items():
    add(f'node_blend_{_name}', f'''
vec3 node_blend_{_name}(float f, vec3 a, vec3 b)
{{
    vec3 other = node_rgb_to_hsv(b);
    if (other.y == 0.0)
        return a;
    vec3 hsv = node_rgb_to_hsv(a);
    {_change}
    return mix(a, node_hsv_to_rgb(hsv), f);
}}
''', 'node_rgb_to_hsv', 'node_hsv_to_rgb')
add('node_blend_saturation', '''
vec3 node_blend_saturation(float f, vec3 a, vec3 b)
{
    vec3 hsv = node_rgb_to_hsv(a);
    if (hsv.y == 0.0)
        return a;
    hsv.y = mix(hsv.y, node_rgb_to_hsv(b).y, f);
    return node_hsv_to_rgb(hsv);
}
''', 'node_rgb_to_hsv', 'node_hsv_to_rgb')
add('node_blend_value', '''
vec3 node_blend_value(float f, vec3 a, vec3 b)
{
    vec3 hsv = node_rgb_to_hsv(a);
    hsv.z = mix(hsv.z, node_rgb_to_hsv(b).z, f);
    return node_hsv_to_rgb(hsv);
}
''', 'node_rgb_to_hsv', 'node_hsv_to_rgb')
