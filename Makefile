# Two commands do everything on a fresh machine: `make run` and `make test`.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin

# Where this is set, every process compiles all modules anew.
unexport PYTHONDONTWRITEBYTECODE

# As in the command itself: with several workers, threads of BLAS mostly wait for a processor.
export OMP_NUM_THREADS := 1

PIP := $(BIN)/python -m pip install --disable-pip-version-check --no-compile

.PHONY: run test lint slow thorough mutants pythons docs screenshots figures package clean

run: $(VENV)/.run
	$(BIN)/rockbatch run configs/near_fault.toml
	$(BIN)/rockbatch run configs/fig7.toml

# With MARKS="not thorough" the slow tests, too, in one session: collection takes 20 s of each core.
test: MARKS ?= not slow
test: $(VENV)/.test
	$(BIN)/python -m pytest -n auto --dist loadfile -m "$(MARKS)"

# Most files have one or two slow tests: in the order of their names these fill the workers better than in that of their counts.
slow: $(VENV)/.test
	$(BIN)/python -m pytest -n auto --dist loadfile --no-loadscope-reorder -m "slow and not thorough"

thorough: $(VENV)/.test
	$(BIN)/python -m pytest -n auto --dist load -m thorough

# Small errors put into the product at random places: do the tests notice? See tests/mutants/run.py.
mutants: $(VENV)/.test
	$(BIN)/python -m pip install --quiet pytest-cov
	$(BIN)/python tests/mutants/run.py --seed $(or $(SEED),1) --count $(or $(COUNT),200)

# The fast tests with every supported Python that is installed, each in an environment of its own.
pythons:
	@for version in 3.11 3.12 3.13 3.14; do \
	  if python$$version -c "" 2> /dev/null; then $(MAKE) test PYTHON=python$$version VENV=.venv-$$version || exit 1; \
	  else echo "python$$version is not installed: not tested"; fi; \
	done

lint: $(VENV)/.test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

docs: $(VENV)/.docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --config-file docs/mkdocs.yml
	@echo "build/docs/index.html"

screenshots: $(VENV)/.run
	$(BIN)/python -m pip install --quiet pypdfium2
	$(BIN)/python docs/screenshots/take.py

# What the pages state of measurements, measured again (benchmarks/figures.py): half an hour, with LONG=1 hours.
figures: $(VENV)/.test
	$(BIN)/python benchmarks/figures.py $(if $(LONG),--long)

# Both files of a release in dist/, checked, and the wheel used from an environment that its user cannot write to.
package:
	bash docs/packaging/try_wheel.sh $(PYTHON)

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "rockbatch needs Python 3.11 or newer; try: make $(MAKECMDGOALS) PYTHON=python3.12"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	@echo "installing rockbatch and what it needs into $(VENV) (about 1 GB)"

# uv takes a sixth of pip's time; pip serves where uv cannot be had or does not reach the registry. Neither compiles modules: those that
# are imported are compiled then.
$(VENV)/.run: EXTRAS := records
$(VENV)/.test: EXTRAS := records,test
$(VENV)/.docs: EXTRAS := docs
$(VENV)/.run $(VENV)/.test $(VENV)/.docs: $(VENV)/bin/python pyproject.toml
	$(PIP) --quiet uv && $(BIN)/uv pip install --python $(BIN)/python --editable ".[$(EXTRAS)]" || $(PIP) --editable ".[$(EXTRAS)]"
	@touch $@ $(if $(filter %.test,$@),$(VENV)/.run)

clean:
	rm -rf .venv .venv-* build *.egg-info
	find . -name __pycache__ -prune -exec rm -rf {} +
