# SPDX-License-Identifier: GPL-3.0-or-later
"""The exhibits of everything.blend: one of each thing that a scene can hold, on plinths in rows."""
