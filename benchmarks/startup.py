"""How long a whole run takes from the shell: cold (derive, compile, solve) and warm (everything cached), in seconds.

Each is a fresh process. Cold runs start with an empty cache; the kernel of the first scene is shipped and only
compiled, that of the second one is derived too.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parent.parent
SCENES = ("helix.toml", "chiral.toml")


def _run(scene: str, cache: str, *words: str) -> float:
    environment = {**os.environ, "GEOCOSSERAT_CACHE": cache, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "geocosserat", "run", str(ROOT / "examples" / scene), "--json", *words]
    start = time.perf_counter()
    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def table(repeats: int = 5) -> str:
    """Markdown: seconds, minimum and median of `repeats`."""
    lines = ["| scene | cold | warm | warm, with files and picture |", "|---|---|---|---|"]
    for scene in SCENES:
        cold, warm, written = [], [], []
        for _ in range(repeats):
            with tempfile.TemporaryDirectory() as name:
                cache, out = f"{name}/cache", f"{name}/out"
                cold.append(_run(scene, cache))
                warm.append(_run(scene, cache))
                written.append(_run(scene, cache, "--out", out))
        cells = (f"{min(t):.2f}, {statistics.median(t):.2f}" for t in (cold, warm, written))
        lines.append(f"| {scene} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table())
