"""How a case of a law is marked as one that takes long, where others of its kind stay quick."""

from typing import Any

import pytest


def slow(*values: Any) -> Any:
    """A set of parameters for the slow part."""
    return pytest.param(*values, marks=pytest.mark.slow)
