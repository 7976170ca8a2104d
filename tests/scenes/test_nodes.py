# SPDX-License-Identifier: GPL-3.0-or-later
"""Every node alone against Cycles: each row of the table of nodes.py within its bound.

A bound that is far above what is measured would hide a fault, and is one: rows must use a fair share of it.
"""

import pytest

import node_cases
import nodes
import renders

# What noise or another driver may change of a row's error.
SLACK = 8.0


@pytest.fixture(scope="module")
def table():
    """Rows by group, each group rendered once."""
    if not renders.panoptes_is_built():
        pytest.skip("the native module is not built; run ./panoptes build")
    if not renders.blender_version().startswith("Blender 3."):
        pytest.skip("the cases name nodes and sockets of Blender 3.4; tests/blender/test_against_cycles.py runs everywhere")
    found = {}

    def rows(group):
        if group not in found:
            found[group] = nodes.compare(group)
        return found[group]

    return rows


def test_the_comparison_sees_a_wrong_tile():
    picture = nodes.np.full((16, 16, 3), 1.0 + node_cases.SCALE * 0.5)
    wrong = picture + 0.01 * node_cases.SCALE
    assert nodes.errors(nodes.tile(picture, 0, 1), nodes.tile(picture, 0, 1), True) == (0.0, 0.0)
    rmse, largest = nodes.errors(nodes.tile(wrong, 0, 1), nodes.tile(picture, 0, 1), True)
    assert rmse == pytest.approx(0.02) and largest == pytest.approx(0.02)


def test_tiles_are_counted_from_the_lower_left():
    picture = nodes.np.zeros((32, 32, 3))
    picture[16:, :16], picture[:16, 16:] = 1.0, 4.0
    assert nodes.tile(picture, 0, 4).mean() == 1.0 and nodes.tile(picture, 3, 4).mean() == 4.0


@pytest.mark.parametrize("group", ["values", "textures", "images", "projections", "bump", "emission", "closures",
                                   pytest.param("alpha", marks=pytest.mark.slow), pytest.param("world", marks=pytest.mark.slow)])
def test_nodes_are_as_in_cycles(table, group):
    over = []
    for row, (rmse, largest, name) in table(group).items():
        bound = node_cases.bound(group, row)
        if not (rmse <= bound.rmse and largest <= bound.largest):
            over.append(f"{row}: {rmse:.2e} and {largest:.2e} of {bound.rmse:.0e} and {bound.largest:.0e} ({name})")
    assert not over, "\n" + "\n".join(over)


@pytest.mark.parametrize("group", sorted({group for group, _ in node_cases.BOUNDS} - {"alpha", "world"}))
def test_no_bound_is_idle(table, group):
    idle = [f"{row}: {table(group)[row][0]:.2e} of {bound.rmse:.0e}" for (owner, row), bound in node_cases.BOUNDS.items()
            if owner == group and table(group)[row][0] < bound.rmse / SLACK]
    assert not idle, idle
