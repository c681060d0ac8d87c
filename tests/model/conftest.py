"""What the tests of the model share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from geocosserat.model.effects import registry


@pytest.fixture(autouse=True)
def _forgetful(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The effects that a test registers are forgotten after it."""
    with monkeypatch.context() as patch:
        patch.setattr(registry, "_KINDS", dict(registry._KINDS))
        yield
