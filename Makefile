# make demo: a rod in motion, from a fresh clone. make test: checks.
# Any POSIX make, Python 3.11 or newer, Linux or macOS. Installing compiles nothing; a C compiler makes runs faster.
.POSIX:
.SUFFIXES:
.PHONY: help demo test bench torture faults fuzz sanitize generated errata clean

PYTHON = python3
OUT = out
TESTS =
BIN = .venv/bin
PIP = $(BIN)/python -m pip --disable-pip-version-check install -q

help:
	@echo "make demo       install into .venv, simulate examples/helix.toml, write numbers and a picture to $(OUT)/demo"
	@echo "make test       lint, types and tests; make test TESTS='-m slow' runs those that take long"
	@echo "make bench      time and accuracy, measured"
	@echo "make torture    scenes that should break a program, by every method: a table, and $(OUT)/torture.jsonl"
	@echo "make faults     end, starve and damage runs at random, and count what is lost (docs/faults.md)"
	@echo "make fuzz       random scenes, laws, solutions and checkpoints"
	@echo "make sanitize   tests on kernels compiled with gcc's sanitisers"
	@echo "make generated  write the kernels in generated/ again"
	@echo "make errata     judge the paper and write docs/errata.md again"
	@echo "make clean      remove .venv, $(OUT) and all caches"
	@echo "another Python: make PYTHON=python3.12 ..."

demo: .venv/installed
	$(BIN)/geocosserat run examples/helix.toml --out $(OUT)/demo --overwrite

test: .venv/tools
	$(BIN)/python -m ruff check .
	$(BIN)/python -m mypy
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n 2 $(TESTS)

bench: .venv/peers
	$(BIN)/python -m benchmarks

torture: .venv/installed
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m benchmarks.torture --lines $(OUT)/torture.jsonl

faults: .venv/tools
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m benchmarks.faults

fuzz: .venv/tools
	$(BIN)/python -m benchmarks.fuzz_scenes
	$(BIN)/python -m benchmarks.fuzz_laws

sanitize: .venv/tools
	$(BIN)/python -m benchmarks.sanitize

generated: .venv/locked
	$(BIN)/python -m geocosserat.codegen.catalogue

errata: .venv/locked
	$(BIN)/python -m paper_checks

clean:
	rm -rf .venv $(OUT) build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

# The files in .venv below are stamps: each says that its step is done. A changed lock makes .venv anew.
.venv/locked: requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	echo 'expected Python 3.11 or newer; name one: make PYTHON=python3.12 ...' >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { \
	echo 'expected a Python with venv and ensurepip; on Debian or Ubuntu: apt-get install python3-venv' >&2; exit 1; }
	rm -rf .venv
	$(PYTHON) -m venv .venv
	$(PIP) --only-binary :all: -r requirements.lock
	touch $@

.venv/installed: .venv/locked pyproject.toml
	$(PIP) --no-deps --no-build-isolation -e .
	touch $@

.venv/tools: .venv/installed requirements-dev.lock
	$(PIP) --only-binary :all: -r requirements-dev.lock
	touch $@

.venv/peers: .venv/tools requirements-bench.lock
	$(PIP) --only-binary :all: -r requirements-bench.lock
	touch $@
