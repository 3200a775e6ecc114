"""The command `fluoropose`."""

import signal
import sys

from ._native import command


def main() -> int:
    """Runs the command line of this process."""
    # Python would only note Ctrl-C and wait for the work to end.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["fluoropose", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
