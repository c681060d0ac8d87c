"""Where the files that come with the program are: inside an installed package, beside it in a checkout."""

from functools import lru_cache
from pathlib import Path


@lru_cache(maxsize=8)
def shipped(name: str) -> Path:
    """The folder `name` ("templates" or "generated").

    Raises FileNotFoundError if the installation is incomplete.
    """
    package = Path(__file__).resolve().parent
    for place in (package / name, package.parent / name):
        if place.is_dir():
            return place
    raise FileNotFoundError(f"expected the folder {name!r} in or beside {package}; install geocosserat again")
