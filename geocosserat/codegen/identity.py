"""The name of a kernel: a hash of everything that decides its text.

Kept apart from the generator, so that finding a kernel that is already there needs no symbolic algebra.
"""

import hashlib
import json
from functools import lru_cache

from geocosserat.discretisation.structure import RodStructure
from geocosserat.shipped import shipped
from geocosserat.version import VERSION


@lru_cache(maxsize=1)
def templates_hash() -> str:
    """Hash of the names and contents of all templates of kernels; those of pages are in a folder below."""
    digest = hashlib.sha256()
    for path in sorted(shipped("templates").glob("*.j2")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def identity(structure: RodStructure) -> str:
    """Hexadecimal hash of structure, templates and version; equal exactly for equal kernels."""
    described = json.dumps([VERSION, templates_hash(), structure.describe()], sort_keys=True)
    return hashlib.sha256(described.encode()).hexdigest()
