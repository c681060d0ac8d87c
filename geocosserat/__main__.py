"""The program `geocosserat`, also as `python -m geocosserat`: Ctrl-C ends it with one line and code 3, at any time."""

import os
import signal
import sys
from types import FrameType


def main() -> None:
    """Runs the command line. An interrupt may come while libraries are imported, which make other errors of it."""
    interrupts = []

    def interrupt(number: int, frame: FrameType | None) -> None:
        interrupts.append(number)
        signal.default_int_handler(number, frame)

    try:
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # else somebody wants it ignored
            signal.signal(signal.SIGINT, interrupt)
        from geocosserat.cli import program

        program()
    except (Exception, KeyboardInterrupt, SystemExit) as end:
        if not interrupts and not isinstance(end, KeyboardInterrupt):
            raise
        code = end.code or 0 if isinstance(end, SystemExit) else 3
        if not isinstance(end, SystemExit):
            print("geocosserat: interrupted", file=sys.stderr)
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        os._exit(code if isinstance(code, int) else 1)  # Python itself would end by the signal where it has seen it


if __name__ == "__main__":
    main()
