# Two commands do everything on a fresh machine: `make run` and `make test`.

PYTHON ?= python3
BIN := .venv/bin

# Where this is set, every process compiles all modules anew.
unexport PYTHONDONTWRITEBYTECODE

# What is imported is compiled then: compiling all of the packages takes as long as unpacking them.
INSTALL := $(BIN)/python -m pip install --no-compile --disable-pip-version-check --editable

.PHONY: run test lint slow thorough pythons docs screenshots clean

run: .venv/.run
	$(BIN)/rockbatch run configs/near_fault.toml
	$(BIN)/rockbatch run configs/fig7.toml

test: .venv/.test
	$(BIN)/python -m pytest -n auto --dist loadfile -m "not slow"

slow: .venv/.test
	$(BIN)/python -m pytest -n auto --dist loadfile -m "slow and not thorough"

thorough: .venv/.test
	$(BIN)/python -m pytest -n auto --dist load -m thorough

lint: .venv/.test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

docs: .venv/.docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --config-file docs/mkdocs.yml
	@echo "build/docs/index.html"

screenshots: .venv/.run
	$(BIN)/python -m pip install --quiet pypdfium2
	$(BIN)/python docs/screenshots/take.py

.venv/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "rockbatch needs Python 3.11 or newer; try: make $(MAKECMDGOALS) PYTHON=python3.12"; exit 1; }
	$(PYTHON) -m venv .venv
	@echo "installing rockbatch and what it needs into .venv (about 1 GB)"

.venv/.run: .venv/bin/python pyproject.toml
	$(INSTALL) ".[records]"
	@touch $@

.venv/.test: .venv/bin/python pyproject.toml
	$(INSTALL) ".[records,test]"
	@touch $@ .venv/.run

.venv/.docs: .venv/bin/python pyproject.toml
	$(INSTALL) ".[docs]"
	@touch $@

clean:
	rm -rf .venv build *.egg-info
	find . -name __pycache__ -prune -exec rm -rf {} +
