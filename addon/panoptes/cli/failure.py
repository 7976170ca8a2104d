# SPDX-License-Identifier: GPL-3.0-or-later
"""The exception that ends a command."""


class Failure(Exception):
    """A command cannot do its work; the text is one sentence with cause and remedy."""


class BadCommandLine(Failure):
    """The command line itself is wrong; nothing was tried."""
