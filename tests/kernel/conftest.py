"""C kernels are compiled while other tests run."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.kernel.kernels import Case, workshop


@pytest.fixture(scope="session", autouse=True)
def prepared(request: pytest.FixtureRequest, cache: Path) -> Iterator[None]:
    """Only the kernels that the collected tests ask for; workers of pytest-xdist keep all cores busy themselves."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        yield
        return
    parameters = (getattr(item, "callspec", None) for item in request.session.items)
    wanted = {p.params["case"]: None for p in parameters if p is not None and isinstance(p.params.get("case"), Case)}
    with workshop(wanted):
        yield
