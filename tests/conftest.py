"""What all tests share: a private cache for kernels, the examples, and a C compiler if there is one."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import hypothesis
import pytest

from geocosserat.kernel import compile as compiling
from geocosserat.kernel.compile import compiler

ROOT = Path(__file__).parents[1]

hypothesis.settings.register_profile("patient", deadline=None)  # no test is judged by a clock
hypothesis.settings.load_profile("patient")


@pytest.fixture(scope="session", autouse=True)
def cache(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """This session's cache: kernels of earlier versions are never used, and the user's own stay untouched.

    Worker processes share it: each kernel is generated and compiled once. Quick tests take a third of the time to do so
    without the optimiser; slow ones, and programs that are started, compile as users do.
    """
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "cache"
    folder.mkdir(mode=0o700, exist_ok=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GEOCOSSERAT_CACHE", str(folder))
        if request.config.option.markexpr == "not slow":
            patch.setattr(compiling, "FLAGS", tuple("-O1" if flag == "-O3" else flag for flag in compiling.FLAGS))
        yield folder


@pytest.fixture(scope="session")
def examples() -> Path:
    """The folder of the example scenes."""
    return ROOT / "examples"


@pytest.fixture(scope="session")
def c_compiler() -> str:
    """Path of the C compiler; tests that need one are skipped where there is none."""
    tool = compiler()
    if tool is None:
        pytest.skip("no C compiler on the path, or CC is set to none")
    return tool


@pytest.fixture
def patience() -> Iterator[None]:
    """Ends a test that would go on for ever; a hundred times what it needs, so it judges no speed."""

    def give_up(*_: object) -> None:
        raise TimeoutError("expected an answer at once, found none within a minute")

    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(60)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)
