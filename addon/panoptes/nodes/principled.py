# SPDX-License-Identifier: GPL-3.0-or-later
"""The Principled BSDF, both generations of its sockets."""

from .. import compat
from .closures import closure, is_black, is_multiscatter
from .values import convert

# Fields of the GLSL struct Principled that are read when their weight is not an unlinked 0: the
# weight first, then (field, kind) of what shapes its term.
_TERMS = {
    'subsurface': (('subsurface_color', 'color'),),
    'transmission': (('transmission_roughness', 'float'),),
    'sheen': (('sheen_roughness', 'float'), ('sheen_tint', 'color')),
    'coat': (('coat_roughness', 'float'), ('coat_ior', 'float'), ('coat_tint', 'color')),
}

# Weights whose term is drawn as something simpler, and what is drawn.
_APPROXIMATED = {
    'subsurface': 'light leaves the surface where it enters',
    'anisotropic': 'the highlight is round',
    'thin_film': 'the film is left out',
}


@closure('BSDF_PRINCIPLED')
def principled(use, weight):
    """Principled BSDF.

    A term whose weight is an unlinked 0 (emission, transmission, coat, sheen; alpha at 1) is left
    at its default, so that the shader compiler removes it.
    """
    compiler = use.compiler
    names = compat.PRINCIPLED_SOCKETS
    variable = f'p{compiler.take_number()}'
    lines = [f'Principled {variable} = principled_defaults(hit);']

    def assign(field, expression):
        lines.append(f'{variable}.{field} = {expression};')

    def read(field, kind):
        name = names.get(field)
        if name is not None and use.has_input(name):
            assign(field, use.get(name, kind))

    def runs(field):
        name = names.get(field)
        return name is not None and use.has_input(name) and use.constant(name) != 0.0

    read('base_color', 'color')
    for field in ('metallic', 'roughness', 'diffuse_roughness', 'specular', 'ior'):
        read(field, 'float')
    read('specular_tint', 'color')
    for term, fields in _TERMS.items():
        if runs(term):
            read(term, 'float')
            for field, kind in fields:
                read(field, kind)
    scales = []
    if use.constant('Alpha') != 1.0:
        compiler.facts['alpha'] = True
        alpha = convert(use.value('Alpha'), 'float')
        scales.append(alpha)
        assign('alpha', alpha.code)
    if not is_black(use, names['emission'], 'Emission Strength'):
        color = convert(use.value(names['emission']), 'color')
        strength = convert(use.value('Emission Strength'), 'float')
        compiler.note_emission(color, strength, *scales)
        assign('emission', f'{color.code} * {strength.code}')
    if is_multiscatter(use):
        assign('multiscatter', 'true')
    assign('normal', use.normal())
    if runs('coat'):
        assign('coat_normal', use.normal(names['coat_normal']))

    if any(runs(field) for field in ('specular', 'metallic', 'coat', 'transmission')):
        compiler.note_glossy(use.constant(names['roughness']))
    if runs('coat'):
        compiler.note_glossy(use.constant(names['coat_roughness']))
    if runs('transmission'):
        compiler.facts['transmission'] = True
    if runs('coat') or runs('sheen'):
        compiler.facts['layers'] = True
    for field, instead in _APPROXIMATED.items():
        if runs(field):
            compiler.warn_once(
                ('principled', field),
                f'{compiler.owner}: input {names[field]} of node {use.node.bl_label} is not fully '
                f'supported yet; {instead}.')
    lines.append(
        f'closure_principled_v{compat.PRINCIPLED_GENERATION}(surface, {weight}, {variable});')
    compiler.lines.extend(lines)
