# SPDX-License-Identifier: GPL-3.0-or-later
"""Entry point: blender -b --factory-startup -P addon/panoptes/cli/main.py -- COMMAND ...

Commands: render, merge, snapshot, viewport. The launcher silences Blender's own output and passes the real
stderr as a file descriptor in PANOPTES_STDERR_FD; progress, warnings and the one line of an error go
there. The exit status is 0 only if the command did what it says.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))

# The package is found only after the line above.
import panoptes  # noqa: E402
from panoptes import native, session  # noqa: E402
from panoptes.cli import arguments, commands  # noqa: E402
from panoptes.cli.console import Console  # noqa: E402
from panoptes.cli.failure import BadCommandLine, Failure  # noqa: E402


def run(words):
    """Run the command line `words`; return the exit status."""
    console = Console()
    try:
        options = arguments.parse(words)
        panoptes.register()
        commands.COMMANDS[options.command](options, console)
        return 0
    except Failure as failure:
        console.error(failure)
        return 2 if isinstance(failure, BadCommandLine) else 1
    except KeyboardInterrupt:
        console.error('Stopped by the user; nothing was written.')
        return 130
    except Exception as error:  # one line is all a script can use
        console.error(session.sentence(error))
    return 1


def main():
    """Read the words after `--` and leave Blender with the command's exit status."""
    words = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    status = run(words)
    if words[:1] == ['viewport'] and status == 0:
        return
    native.close()
    sys.stdout.flush()
    sys.exit(status)


if __name__ == '__main__':
    main()
