"""From text to a kernel that runs."""

import importlib.machinery
import importlib.util
import types
from functools import lru_cache

from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.kernel.compile import opened
from geocosserat.kernel.library import KernelText
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod


@lru_cache(maxsize=64)
def _module(text: str, identity: str) -> types.ModuleType:
    """The generated numpy module; its text comes from this program's own templates, never from a scene. Kept, since
    Python takes longer to compile it than a rod of another value takes to be set up."""
    name = f"geocosserat_kernel_{identity[:16]}"
    loader = _TextLoader(text, name)
    spec = importlib.util.spec_from_loader(name, loader)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


class _TextLoader(importlib.machinery.SourceFileLoader):
    """Loads a module from text, without a file and without bytecode left behind."""

    def __init__(self, text: str, name: str) -> None:
        super().__init__(name, f"<{name}>")
        self._text = text.encode()

    def get_data(self, path: str) -> bytes:
        return self._text

    def path_stats(self, path: str) -> dict[str, float]:
        raise OSError("text without a file")


def load(text: KernelText, rod: SemiDiscrete, backend: str) -> NativeRod | NumpyRod:
    """The kernel of `rod` in C ("c") or numpy ("numpy").

    Raises CompileError if C was asked for and cannot be compiled or loaded.
    """
    if backend == "c":
        return opened(lambda library: NativeRod(library, rod), text.c, rod.mesh.degree)
    return NumpyRod(_module(text.numpy, text.identity), rod)
