"""The command line: `python -m ropewalk` and `ropewalk`."""

import signal
import sys

from . import _native


def main() -> int:
    # Python's own handler would only be asked when the command has ended
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.main("ropewalk", *sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
