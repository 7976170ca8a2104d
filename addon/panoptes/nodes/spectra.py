# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours of spectra: Blackbody and Wavelength, by the CIE 1931 observer (2 degrees)."""

import numpy as np

from .compiler import value_node
from .values import Value

# Colour matching functions x, y, z every 5 nm from 380 to 780 nm (CIE 1931, four decimals).
_STEP = 5.0
_FIRST, _LAST = 380.0, 780.0
_OBSERVER = np.array("""
.0014 .0000 .0065 .0022 .0001 .0105 .0042 .0001 .0201 .0076 .0002 .0362 .0143 .0004 .0679
.0232 .0006 .1102 .0435 .0012 .2074 .0776 .0022 .3713 .1344 .0040 .6456 .2148 .0073 1.0391
.2839 .0116 1.3856 .3285 .0168 1.6230 .3483 .0230 1.7471 .3481 .0298 1.7826 .3362 .0380 1.7721
.3187 .0480 1.7441 .2908 .0600 1.6692 .2511 .0739 1.5281 .1954 .0910 1.2876 .1421 .1126 1.0419
.0956 .1390 .8130 .0580 .1693 .6162 .0320 .2080 .4652 .0147 .2586 .3533 .0049 .3230 .2720
.0024 .4073 .2123 .0093 .5030 .1582 .0291 .6082 .1117 .0633 .7100 .0782 .1096 .7932 .0573
.1655 .8620 .0422 .2257 .9149 .0298 .2904 .9540 .0203 .3597 .9803 .0134 .4334 .9950 .0087
.5121 1.0000 .0057 .5945 .9950 .0039 .6784 .9786 .0027 .7621 .9520 .0021 .8425 .9154 .0018
.9163 .8700 .0017 .9786 .8163 .0014 1.0263 .7570 .0011 1.0567 .6949 .0010 1.0622 .6310 .0008
1.0456 .5668 .0006 1.0026 .5030 .0003 .9384 .4412 .0002 .8544 .3810 .0002 .7514 .3210 .0001
.6424 .2650 .0000 .5419 .2170 .0000 .4479 .1750 .0000 .3608 .1382 .0000 .2835 .1070 .0000
.2187 .0816 .0000 .1649 .0610 .0000 .1212 .0446 .0000 .0874 .0320 .0000 .0636 .0232 .0000
.0468 .0170 .0000 .0329 .0119 .0000 .0227 .0082 .0000 .0158 .0057 .0000 .0114 .0041 .0000
.0081 .0029 .0000 .0058 .0021 .0000 .0041 .0015 .0000 .0029 .0010 .0000 .0020 .0007 .0000
.0014 .0005 .0000 .0010 .0004 .0000 .0007 .0002 .0000 .0005 .0002 .0000 .0003 .0001 .0000
.0002 .0001 .0000 .0002 .0001 .0000 .0001 .0000 .0000 .0001 .0000 .0000 .0001 .0000 .0000
.0000 .0000 .0000""".split(), float).reshape(-1, 3)

_RGB_FROM_XYZ = np.array(((3.2404542, -1.5371385, -0.4985314), (-0.9692660, 1.8760108, 0.0415560),
                          (0.0556434, -0.2040259, 1.0572252)))

# Cycles' own: it makes every component of every wavelength's colour less than 1.
_WAVELENGTH_SCALE = 1.0 / 2.52
# Outside, the colour is that of the nearer end, as in Cycles.
_COOLEST, _HOTTEST = 800.0, 12000.0
_TABLE_SIZE = 256


def blackbody(kelvin):
    """Return the colour (r, g, b) of a black body, of luminance 1; out of gamut below some 1900 K."""
    metres = np.arange(_FIRST, _LAST + 1.0, _STEP) * 1e-9
    kelvin = min(max(kelvin, _COOLEST), _HOTTEST)
    exponent = 0.01438777 / (metres * kelvin)  # Planck's law, up to a factor
    radiance = metres**-5 / np.expm1(exponent)
    xyz = radiance @ _OBSERVER
    return tuple(_RGB_FROM_XYZ @ (xyz / xyz[1]))


@value_node('BLACKBODY')
def blackbody_node(use, output):
    """Blackbody node: one parameter, or a table over the reciprocal of the temperature."""
    compiler = use.compiler
    constant = use.constant('Temperature')
    if constant is not None:
        color = tuple(max(c, 0.0) for c in blackbody(constant))
        return compiler.parameter('color', color)
    low, high = 1.0 / _HOTTEST, 1.0 / _COOLEST
    steps = np.linspace(low, high, _TABLE_SIZE)
    rows = [(*blackbody(1.0 / step), 0.0) for step in steps]
    kelvin = use.get('Temperature', 'float')
    place = f'(1.0 / max({kelvin}, 1.0) - {low:.9e}) * {1.0 / (high - low):.9e}'
    return use.declare('color', f'max({_lookup(compiler, rows, place)}.xyz, vec3(0.0))')


@value_node('WAVELENGTH')
def wavelength(use, output):
    """Wavelength node."""
    compiler = use.compiler
    rows = [(*row, 0.0) for row in _OBSERVER @ _RGB_FROM_XYZ.T * _WAVELENGTH_SCALE]
    nanometres = use.declare('float', use.get('Wavelength', 'float')).code
    color = _lookup(compiler, rows, f'({nanometres} - {_FIRST}) * {1.0 / (_LAST - _FIRST):.9e}')
    return Value('color', use.declare(
        'color', f'{nanometres} < {_FIRST} || {nanometres} > {_LAST} ? vec3(0.0) : '
                 f'max({color}.xyz, vec3(0.0))').code)


def _lookup(compiler, rows, place):
    first = compiler.parameters.table(rows)
    return f'{compiler.helper("node_table")}({first}, {len(rows) - 1}, {place}, true)'
