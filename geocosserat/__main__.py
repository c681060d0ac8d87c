"""`python -m geocosserat` is the program `geocosserat`."""

import sys

from geocosserat.cli import main

if __name__ == "__main__":
    sys.exit(main())
