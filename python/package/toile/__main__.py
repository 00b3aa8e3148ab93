"""The command ``toile``, the same program as the one that cargo builds.

``--plugin stages.py`` runs a file of Python whose stages the command then knows.
"""

from __future__ import annotations

import os
import runpy
import signal
import sys

from toile import _toile


def _split(arguments: list[str]) -> tuple[list[str], list[str]]:
    """Files of Python that ``--plugin`` names, and the other arguments."""
    files: list[str] = []
    others: list[str] = []
    rest = iter(arguments)
    for argument in rest:
        value = argument.removeprefix("--plugin=") if argument.startswith("--plugin=") else None
        if argument == "--plugin":
            value = next(rest, None)
        if value is not None and value.endswith(".py"):
            files.append(value)
        elif argument == "--plugin" and value is not None:
            others += [argument, value]
        else:
            others.append(argument)
    return files, others


def main() -> None:
    """Runs the command and ends the program with its exit code."""
    files, others = _split(sys.argv[1:])
    # Processes of a batch stand in another folder.
    files = [os.path.abspath(file) for file in files]
    for file in files:
        try:
            runpy.run_path(file)
        except FileNotFoundError:
            print(f'error: there is no file "{file}"', file=sys.stderr)
            sys.exit(3)
    start = [sys.executable, "-m", "toile"]
    for file in files:
        start += ["--plugin", file]
    # The command listens to Ctrl-C itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_toile.command(["toile", *others], start))


if __name__ == "__main__":
    main()
