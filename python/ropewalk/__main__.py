"""The command line: `python -m ropewalk` and `ropewalk`."""

import signal
import sys

from . import _native


def main() -> int:
    arguments = sys.argv[1:]
    if arguments[:1] == ["sweep"] and any(word.split("=")[0] == "--dask" for word in arguments):
        from ._cluster import command

        return command(arguments)
    if arguments[:1] == ["export-fmu"] and not any(word.split("=")[0] == "--library" for word in arguments):
        from ._fmu import library

        found = library()
        arguments += ["--library", str(found)] if found else []
    # Python's own handler would only be asked when the command has ended
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.main("ropewalk", *arguments)


if __name__ == "__main__":
    sys.exit(main())
