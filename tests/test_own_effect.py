"""An effect of one's own, as docs/effects.md writes it, from the scene to a rod that has settled."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", (ROOT / "docs" / "effects.md").read_text(), re.MULTILINE | re.DOTALL)
FLOOR = next(text for language, text in BLOCKS if language == "python" and "class Floor" in text)
SETTLING = next(text for language, text in BLOCKS if language == "toml" and "floor" in text)

RUN = """
import json, sys
import numpy as np
import geocosserat

run = geocosserat.run(sys.stdin.read(), settings=["run.until=400", "run.frames=2", f"run.backend={sys.argv[1]}"])
y, u = run.solution.position[-1, :, 1], run.solution.u
print(json.dumps({"reached": run.reached, "y": y.tolist(), "u": u.tolist(), "ledger": run.ledger["residual"],
                  "moving": float(np.abs(run.solution.twist[-1]).max()), "backend": run.backend}))
"""


@pytest.mark.parametrize("backend", ["auto", "numpy"])
def test_a_rod_settles_where_the_floor_of_the_docs_carries_its_weight(backend: str, tmp_path: Path) -> None:
    """In a process of its own: at rest, and the push of the floor, integrated along the rod, is the whole weight."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])}
    command = [sys.executable, "-c", FLOOR + RUN, backend]
    done = subprocess.run(command, input=SETTLING, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["reached"]
    assert found["moving"] < 1e-6
    assert found["ledger"] < 1e-5
    y, u = np.array(found["y"]), np.array(found["u"])
    # the nodes are too uneven for a rule of their own: the push as a polynomial of the place
    push = np.polynomial.Chebyshev.fit(u, (2 + u) * np.exp(-y / 0.05), min(len(u) - 1, 20)).integ()
    assert push(1.0) - push(0.0) == pytest.approx(1.0, abs=1e-5)


def test_the_effect_of_the_docs_is_as_short_as_promised() -> None:
    """Under 20 lines."""
    assert len(FLOOR.strip().splitlines()) < 20
