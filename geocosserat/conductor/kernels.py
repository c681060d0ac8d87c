"""The kernel of a scene, and what it runs on.

Symbolic algebra and code generation are imported only when they are needed: a run whose kernel is already built starts
in a fraction of a second.
"""

import sys
from collections.abc import Callable
from typing import TypeVar

from geocosserat.codegen.identity import identity
from geocosserat.discretisation.structure import RodStructure
from geocosserat.kernel.compile import CompileError, compiler
from geocosserat.kernel.library import KernelText, find, store
from geocosserat.model.errors import InputError

T = TypeVar("T")


def kernel_text(structure: RodStructure) -> KernelText:
    """The kernel of a structure: shipped, cached, or generated now (the only case that needs symbolic algebra)."""
    name = identity(structure)
    found = find(name)
    if found is not None:
        return found
    from geocosserat.codegen.source import generate as generate_source

    source = generate_source(structure)
    return store(name, source.c, source.numpy, source.signature)


def tell(message: str) -> None:
    print(message, file=sys.stderr)


def choose_backend(asked: str) -> str:
    """ "c" or "numpy"; says so when numpy takes over for want of a compiler.

    Raises InputError if C was asked for and there is no compiler.
    """
    if asked == "numpy":
        return "numpy"
    if compiler() is not None:
        return "c"
    if asked == "c":
        raise InputError("a C compiler", "none on the path", 'install one, or set backend = "numpy"', key="run.backend")
    tell("no C compiler found: running on numpy, with the same results in more time")
    return "numpy"


def on_backend(asked: str, chosen: str, work: Callable[[str], T]) -> T:
    """The work done on the backend that was chosen, or on numpy if C was not asked for and turns out not to compile."""
    try:
        return work(chosen)
    except CompileError as error:
        if asked == "c":
            raise
        tell(f"{error}; running on numpy instead")
        return work("numpy")
