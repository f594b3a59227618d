# Needs python3 (3.11 or newer) with venv, and make; everything else goes into .venv.
PYTHON ?= python3
VENV   ?= .venv
DEMO   ?= demo-out
RECORDS ?= ../shared/records/paper_suite
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-input
SHELL  := /bin/bash

.PHONY: help demo test lint format types layers docs bench bench-gpu validate mutants pins suite constraints clean
.NOTPARALLEL:
.DELETE_ON_ERROR:

help:
	@echo "make demo | test | lint | format | types | layers | docs | bench | bench-gpu | validate | mutants | pins | suite | clean"

demo: $(VENV)/.ready-run
	$(BIN)/railquake demo --out $(DEMO)

test: $(VENV)/.ready-dev
	$(BIN)/python -m pytest -n 2 --dist loadscope --no-loadscope-reorder

lint: $(VENV)/.ready-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

format: $(VENV)/.ready-dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

types: $(VENV)/.ready-dev
	$(BIN)/mypy

layers: $(VENV)/.ready-dev
	$(BIN)/lint-imports

docs: $(VENV)/.ready-docs
	$(BIN)/sphinx-build -W --keep-going --quiet -b html docs docs/_build/html
	@echo "docs/_build/html/index.html"

bench: $(VENV)/.ready-bench
	$(BIN)/railquake bench
	$(BIN)/python benchmarks/shortcuts.py $(RECORDS)
	$(BIN)/python benchmarks/lockstep_memory.py

# On a machine with an NVIDIA GPU; elsewhere it says that nothing was measured.
bench-gpu: $(VENV)/.ready-gpu
	$(BIN)/railquake bench --device cuda

# Every comparison, and the documentation's page of them; the reference data lie in ../shared.
validate: $(VENV)/.ready-fem
	$(BIN)/railquake validate --page docs/validation.md

# Whether the tests can fail; about an hour on a free core, minutes with EVERY=20 (a sample).
EVERY ?= 1
mutants: $(VENV)/.ready-dev
	$(BIN)/python tools/mutants.py --every $(EVERY)

# Every pinned number, old against new; minutes.
pins: $(VENV)/.ready-dev
	$(BIN)/python tools/pins.py --records $(RECORDS)

# The paper's suite with other cars, with half the step and by themselves: an hour on two cores.
suite: $(VENV)/.ready-dev
	$(BIN)/python tools/suite.py --records $(RECORDS) --halved --single

# One stamp per set of packages.  Each holds when the interpreter and both lists are older than it.
$(VENV)/.ready-run:   EXTRAS :=
$(VENV)/.ready-dev:   EXTRAS := [dev]
$(VENV)/.ready-docs:  EXTRAS := [docs]
$(VENV)/.ready-bench: EXTRAS := [bench]
$(VENV)/.ready-fem:   EXTRAS := [fem]
$(VENV)/.ready-gpu:   EXTRAS := [gpu]
$(VENV)/.ready-run $(VENV)/.ready-dev $(VENV)/.ready-docs $(VENV)/.ready-bench \
		$(VENV)/.ready-fem $(VENV)/.ready-gpu: $(VENV)/.created pyproject.toml constraints.txt
	@echo "Installing railquake$(EXTRAS) into $(VENV) (a minute or so, once)"
	@$(PIP) -c constraints.txt -e ".$(EXTRAS)"
	@touch $@

$(VENV)/.created:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "railquake needs Python 3.11 or newer: make PYTHON=python3.12 ..."; exit 1; }
	@$(PYTHON) -m venv $(VENV)
	@touch $@

# Renews the pinned versions from what pip chooses now (delete constraints.txt to let it choose).
constraints:
	rm -rf $(VENV)-pins
	$(PYTHON) -m venv $(VENV)-pins
	touch constraints.txt
	$(VENV)-pins/bin/python -m pip install --quiet --upgrade setuptools
	$(VENV)-pins/bin/python -m pip install --quiet -c constraints.txt -e ".[dev,docs]"
	{ echo "# Every version that the Makefile installs; see CONTRIBUTING.md, Dependencies."; \
	  $(VENV)-pins/bin/python -m pip freeze --all --exclude pip --exclude-editable; } > constraints.new
	mv constraints.new constraints.txt
	rm -rf $(VENV)-pins

clean:
	rm -rf $(VENV) $(VENV)-pins $(DEMO) build dist docs/_build docs/reference
	rm -rf .pytest_cache .hypothesis .mypy_cache .ruff_cache .import_linter_cache
	find src tests -name __pycache__ -type d -prune -exec rm -rf {} +
