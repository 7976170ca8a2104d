# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks generated GLSL with glslangValidator behind the real shader prelude."""

import os
import re
import shutil
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SHADERS = os.path.join(ROOT, 'shaders')

_MAIN = {
    'material': '''
layout(local_size_x = 1) in;
layout(binding = 0, rgba32f) writeonly uniform image2D target;
void main()
{
    Hit hit = fetch_hit(view_ray(vec2(0.5)), 0u, 0u);
    Surface surface = empty_surface();
    evaluate_material(hit, surface);
    finish_surface(hit, surface);
    imageStore(target, ivec2(0), vec4(surface.diffuse + surface.specular + surface.emission, 1.0));
}
''',
    'world': '''
layout(local_size_x = 1) in;
layout(binding = 0, rgba32f) writeonly uniform image2D target;
void main() { imageStore(target, ivec2(0), vec4(evaluate_world(vec3(0.0, 0.0, 1.0)), 1.0)); }
''',
}


def available():
    """Tell whether the validator and the prelude are there."""
    return (shutil.which('glslangValidator') is not None
            and os.path.isfile(os.path.join(SHADERS, 'gpu_scene', 'material.glsl')))


def _expand(name, generated, seen):
    """Return a shader file with its includes inlined, each file once."""
    if name in seen:
        return ''
    seen.add(name)
    if name.startswith('generated/'):
        return generated
    with open(os.path.join(SHADERS, name), encoding='utf-8') as file:
        text = file.read()
    text = re.sub(r'^#pragma once.*$', '', text, flags=re.MULTILINE)
    return re.sub(r'^#include "([^"]+)".*$',
                  lambda match: _expand(match[1], generated, seen), text, flags=re.MULTILINE)


def program(shader, domain):
    """Return a compute shader around a `CompiledShader`; `domain` is 'material' or 'world'."""
    defines = {'IMAGE_COUNT': len(shader.textures), 'ALPHA': int(shader.facts['alpha']),
               'GLOSSY': int(shader.facts['glossy']), 'EMISSION': int(shader.facts['emission'])}
    head = '#version 460 core\n' + ''.join(f'#define {k} {v}\n' for k, v in defines.items())
    seen = set()
    text = _expand(f'gpu_scene/{domain}.glsl', shader.code, seen)
    if f'generated/{domain}.glsl' not in seen:
        text += '\n' + shader.code
    return head + text + _MAIN[domain]


def validate(folder, shaders, domain='material'):
    """Return '' if all these `CompiledShader`s are valid, else the validator's report."""
    paths = []
    for text in dict.fromkeys(program(shader, domain) for shader in shaders):
        paths.append(os.path.join(str(folder), f'{domain}{len(paths)}.comp'))
        with open(paths[-1], 'w', encoding='utf-8') as file:
            file.write(text)
    done = subprocess.run(['glslangValidator', *paths], capture_output=True, text=True, check=False)
    return '' if done.returncode == 0 else done.stdout + done.stderr
