"""Error of the tip against degree and elements: the relaxing planar rod and the helical spring, in Markdown tables.

The reference is the same scheme at degree 24 on several elements and a tolerance of 1e-13; the tests compare with
references that share no code with it.
"""

from pathlib import Path

import numpy as np

import geocosserat

EXAMPLES = Path(__file__).parent.parent / "examples"
SETTINGS = [(1, 4), (1, 8), (1, 12), (1, 16), (16, 1), (64, 1), (256, 1)]


def tip(scene: str, elements: int, degree: int, rtol: float) -> np.ndarray:
    """Position of the right end at the final time, a length."""
    changes = [f"run.elements={elements}", f"run.degree={degree}", f"run.rtol={rtol}", "run.frames=2"]
    return np.array(geocosserat.run(EXAMPLES / scene, settings=changes).tip["position"])


def table(scene: str, reference: tuple[int, int]) -> str:
    """One row: unknowns are degree x elements x dimension; errors relative to the length 1."""
    exact = tip(scene, *reference, 1e-13)
    errors = [float(np.linalg.norm(tip(scene, n, p, 1e-12) - exact)) for n, p in SETTINGS]
    heading = "| " + " | ".join(f"{n} x degree {p}" for n, p in SETTINGS) + " |"
    return "\n".join([heading, "|" + "---|" * len(SETTINGS), "| " + " | ".join(f"{e:.1e}" for e in errors) + " |"])


def tables() -> str:
    """Both scenes, in Markdown."""
    scenes = {"cantilever.toml": (2, 24), "helix.toml": (4, 24)}
    return "\n".join(f"{scene}\n\n{table(scene, reference)}\n" for scene, reference in scenes.items())


if __name__ == "__main__":
    print(tables())
