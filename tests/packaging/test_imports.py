"""Which module may import what: the one direction in which data flow, kept by reading every import statement."""

import ast
import graphlib
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

ROOT = Path(__file__).parents[2]

STAGES = {
    # stage (a folder, or one module): the stages and modules it may import besides its own and BASE
    "algebra": (),
    "model": ("algebra",),
    "effects": ("model",),  # the public face for effects of one's own
    "derivation": ("algebra", "model"),
    "discretisation": ("algebra", "model", "derivation"),
    "codegen": ("algebra", "model", "derivation", "discretisation"),
    "kernel": ("algebra", "model", "discretisation"),  # kernels are text by now: no sympy, no templates
    "solver": ("kernel.contract", "kernel.compile"),  # integrates anything that keeps the contract; knows no rods
    "statics": ("kernel.contract",),  # where any such system rests; knows no rods
    "results": ("bounded", "algebra.groups", "model.errors", "kernel.contract", "solver.trajectory"),
    "planning": ("algebra.groups", "discretisation.mesh", "model"),  # which setting, for which accuracy
    "referee": ("algebra",),  # judges statements about rods; knows no paper
    "bounded": (),  # work in a process of its own
    "passivity": ("algebra", "model", "derivation.convert", "derivation.notation", "referee.decide"),  # judges laws
}
BASE = ("version", "shipped", "locks")  # free to all; import nothing of the package
SEE_ALL = ("", "__main__", "cli", "conductor")  # "" is geocosserat/__init__.py

EVERYWHERE = ("",)
LIBRARIES = {
    # library: the stages and modules that may import it
    "cffi": ("kernel", "solver"),
    "click": ("cli",),
    "flint": ("passivity",),
    "h5netcdf": ("results",),
    "h5py": ("results",),
    "jinja2": ("codegen", "referee.page"),
    "latex2mathml": ("referee.mathml",),
    "markupsafe": ("referee.page",),
    "matplotlib": ("results", "passivity.picture", "passivity.portrait"),
    "mpl_toolkits": ("results",),
    "mpmath": ("algebra.symbolic", "derivation", "referee.decide"),
    "numpy": EVERYWHERE,
    "paper_checks": ("conductor", "cli"),  # no library, but what is checked: nothing else may depend on it
    "rich": ("results", "conductor", "cli", "referee.show", "passivity.show"),
    "scipy": EVERYWHERE,
    "sksundae": ("solver",),
    "sympy": (
        "algebra.symbolic", "algebra.fields", "derivation", "discretisation.material", "discretisation.pointwise",
        "codegen", "referee", "passivity",
    ),
    "xarray": ("results",),
}
DISTRIBUTION = {"flint": "python-flint", "mpl_toolkits": "matplotlib", "sksundae": "scikit-sundae"}
LATE = {
    # who may import inside a function, and what
    "__main__": ("geocosserat.cli",),  # listens for interrupts first
    "conductor": EVERYWHERE,
    "cli": EVERYWHERE,
    "results": ("matplotlib", "mpl_toolkits", "xarray"),
}
PAPER = ("algebra", "model", "derivation", "discretisation", "referee")
"""What the records of the paper may import of the package: they run nothing and write nothing."""
SLOW_TO_IMPORT = ("jinja2", "latex2mathml", "matplotlib", "paper_checks", "pandas", "sympy", "xarray")
RUNS_TEXT = ("__import__", "compile", "eval", "exec", "lambdify", "parse_expr", "sympify")


@dataclass(frozen=True)
class Import:
    """One imported name, in full; late: inside a function."""

    module: str
    name: str
    line: int
    late: bool

    def __str__(self) -> str:
        return f"geocosserat/{self.module.replace('.', '/')}.py:{self.line}: {self.name}"


def _within(name: str, allowed: tuple[str, ...]) -> bool:
    return any(name == part or name.startswith(f"{part}.") or part == "" for part in allowed)


def _top(name: str) -> str:
    return name.split(".")[0]


@lru_cache(maxsize=1)
def _trees() -> dict[str, ast.Module]:
    """Every module of the package, by its name without `geocosserat.`."""
    package = ROOT / "geocosserat"
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = ast.parse(path.read_text(), str(path))
    assert len(found) > 50
    return found


def _statements(tree: ast.AST, late: bool = False) -> Iterator[tuple[ast.Import | ast.ImportFrom, bool]]:
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node, late
        inside = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        yield from _statements(node, late or inside)


@lru_cache(maxsize=1)
def _imports() -> tuple[Import, ...]:
    found = []
    for module, tree in _trees().items():
        for node, late in _statements(tree):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            else:
                assert node.level == 0, f"{module}:{node.lineno}: expected the full name of a module"
                assert node.module is not None
                names = [_origin(node.module, alias.name) for alias in node.names]
            found += [Import(module, name, node.lineno, late) for name in names]
    return tuple(found)


def _origin(module: str, name: str) -> str:
    """`from a.b import c` imports the module a.b.c if there is one, else something of a.b."""
    whole = f"{module}.{name}"
    return whole if whole.removeprefix("geocosserat.") in _trees() else module


def _own() -> list[Import]:
    """Imports from one module of the package to another; their names without `geocosserat.`."""
    return [
        Import(found.module, found.name.removeprefix("geocosserat").removeprefix("."), found.line, found.late)
        for found in _imports()
        if _within(found.name, ("geocosserat",))
    ]


def _libraries() -> list[Import]:
    return [
        found for found in _imports() if _top(found.name) not in (*sys.stdlib_module_names, "geocosserat", "__future__")
    ]


def _listed(wrong: list[Import]) -> str:
    return "not allowed by the table in tests/packaging/test_imports.py:\n" + "\n".join(map(str, wrong))


def test_every_module_belongs_to_a_stage() -> None:
    """A new folder or module of the top level needs its place in the tables above."""
    known = {*STAGES, *BASE, *SEE_ALL}
    assert {_top(module) for module in _trees()} <= known


def test_a_stage_imports_only_what_lies_before_it() -> None:
    """Data flow in one direction; solvers know no rods; nothing but the conductor sees all stages."""
    wrong = []
    for found in _own():
        stage = _top(found.module)
        allowed = (*BASE, stage, *STAGES[stage]) if stage in STAGES else ()
        if stage not in SEE_ALL and not _within(found.name, allowed):
            wrong.append(found)
    assert not wrong, _listed(wrong)


def test_a_library_is_imported_only_where_it_belongs() -> None:
    """Symbols stay in the symbolic stages, files and pictures in the results, time stepping in the solver."""
    wrong = [found for found in _libraries() if not _within(found.module, LIBRARIES.get(_top(found.name), ()))]
    assert not wrong, _listed(wrong)


def test_every_imported_library_is_a_declared_dependency() -> None:
    """What the package imports, its installation brings."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    declared = project["dependencies"] + project["optional-dependencies"]["xarray"]
    names = {text.split(">")[0] for text in declared}
    imported = {_top(found.name) for found in _libraries()} - {"paper_checks"}  # which comes in the same wheel
    assert {DISTRIBUTION.get(name, name) for name in imported} <= names


def test_imports_inside_functions_are_the_conductors() -> None:
    """A hidden import hides a dependency; the conductor may wait for one, results for a heavy library."""
    wrong = [found for found in _imports() if found.late and not _within(found.name, LATE.get(_top(found.module), ()))]
    assert not wrong, _listed(wrong)


def test_the_paper_is_judged_by_what_needs_no_run() -> None:
    """Its records see algebra, models and derivations; no kernel, no solver, no file, and nothing hidden."""
    allowed = ("numpy", "paper_checks", "sympy", *(f"geocosserat.{stage}" for stage in PAPER))
    wrong = []
    for path in sorted((ROOT / "paper_checks").glob("*.py")):
        for node, late in _statements(ast.parse(path.read_text(), str(path))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else [str(node.module)]
            outside = [n for n in names if _top(n) not in sys.stdlib_module_names and not _within(n, allowed)]
            wrong += [f"{path.name}:{node.lineno}: {name}" for name in (names if late else outside)]
    assert not wrong


def test_no_module_imports_itself_through_others() -> None:
    """The graph of all imports of the package has no cycle."""
    graph: dict[str, set[str]] = {module: set() for module in _trees()}
    for found in _own():
        graph[found.module].add(found.name)
    tuple(graphlib.TopologicalSorter(graph).static_order())


def test_stage_packages_are_empty() -> None:
    """A stage is its modules; importing one of them brings nothing else along."""
    folders = [stage for stage in STAGES if (ROOT / "geocosserat" / stage).is_dir()]
    assert len(folders) >= 8
    assert [stage for stage in folders if _trees()[stage].body] == []


def test_no_text_is_ever_run() -> None:
    """Scenes reach no evaluator. sympify is one unless strict; compile is harmless as a method (re.compile)."""
    wrong = []
    for module, tree in _trees().items():
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call):
                continue
            name = getattr(node.func, "id", None) or getattr(node.func, "attr", "")
            method = isinstance(node.func, ast.Attribute)
            strict = any(k.arg == "strict" and getattr(k.value, "value", None) is True for k in node.keywords)
            if name in RUNS_TEXT and not (method and name == "compile") and not (name == "sympify" and strict):
                wrong.append(Import(module, name, node.lineno, False))
    assert not wrong, _listed(wrong)


def test_a_warm_run_imports_nothing_slow() -> None:
    """The program starts without its symbolic stages and without its plotting and table libraries."""
    code = "import sys, geocosserat.cli, geocosserat.conductor; print(*sys.modules)"
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60, check=True)
    loaded = done.stdout.split()
    assert "geocosserat.conductor" in loaded
    assert [name for name in SLOW_TO_IMPORT if name in loaded] == []
