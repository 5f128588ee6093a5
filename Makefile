# Every target does its own set-up; it needs cargo, a C linker and Python 3.11 or later.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PEERS := .venv-peers
MASTERS := .venv-masters
NAMES := $(sort $(patsubst examples/%/scene.toml,%,$(wildcard examples/*/scene.toml)))
EXAMPLES := $(sort $(patsubst examples/%/run.py,%,$(wildcard examples/*/run.py)))
RELEASE := target/release
PY_FILES := $(wildcard python build-fmu/*.py tests/conftest.py tests/fmpy tests/python tests/verification benches examples docs/conf.py docs/manual)

.DEFAULT_GOAL := help
.PHONY: help demo docs units examples test rust-test python-test pytest fuzz verify bench charts maps bench-droplet bench-reduced build clean

help: ## say what there is
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /  make \1\t/' | expand -t 20

demo: build $(VENV)/ready ## pack the alumina plate, run it and draw pictures
	@mkdir -p out
	$(RELEASE)/build-fmu examples/alumina_plate/scene.toml -o out/alumina_plate.fmu
	$(BIN)/python examples/alumina_plate/run.py
	@echo "Pictures:"; find out/alumina_plate -name '*.png' -o -name '*.gif' | sort | sed 's/^/  /'

docs: $(VENV)/ready ## build the manual, which needs no network to be read
	$(BIN)/python -m sphinx --fail-on-warning --keep-going --quiet -b html -c docs . out/manual
	@echo "Manual: out/manual/index.html"

units: build ## pack every example that is one unit into out/
	@mkdir -p out
	@set -e; for name in $(NAMES); do $(RELEASE)/build-fmu examples/$$name/scene.toml -o out/$$name.fmu; done

examples: units $(VENV)/ready ## run every example
	@set -e; for name in $(EXAMPLES); do echo "== $$name"; $(BIN)/python examples/$$name/run.py; done

# Once all is built, tests in Python fill the cores while the compiler of further Rust tests leaves them idle. A failure
# of one does not cut the other short.
test: build $(VENV)/ready ## everything that is fast
	@$(MAKE) --no-print-directory --jobs=2 --keep-going --output-sync=target rust-test pytest

# All test programs but that of `make verify`.
FOLDERS := $(notdir $(patsubst %/main.rs,%,$(wildcard tests/*/main.rs cli/tests/*/main.rs)))
TESTS := $(filter-out verification,$(FOLDERS)) \
	$(basename $(notdir $(wildcard tests/*.rs build-fmu/tests/*.rs)))

# Tests within the library compile it once more, for themselves: without optimisation that takes a fifth of the time,
# and they check for overflows and debug assertions, too. All other tests run what is packed.
UNOPTIMISED := --config profile.release.package.impinge.opt-level=0 \
	--config profile.release.package.impinge.debug-assertions=true \
	--config profile.release.package.impinge.overflow-checks=true

rust-test:
	cargo fmt --all --check
	cargo clippy --release --workspace --all-targets -- -D warnings
	cargo test --release --workspace --bins $(TESTS:%=--test %)
	cargo test --release --package closed-form --package fmu-lint --lib
	cargo test --release --workspace --doc
	cargo test --release --package impinge --lib $(UNOPTIMISED)

python-test: build $(VENV)/ready
	@$(MAKE) --no-print-directory pytest

# Once all is built and installed.
pytest:
	$(BIN)/ruff check $(PY_FILES)
	$(BIN)/ruff format --check $(PY_FILES)
	IMPINGE_BIN=$(CURDIR)/$(RELEASE) $(BIN)/python -m pytest tests/fmpy tests/python --numprocesses auto --maxprocesses 4 --dist worksteal

SECONDS ?= 600

fuzz: ## drive the C ABI with random calls for SECONDS seconds
	FUZZ_SECONDS=$(SECONDS) cargo test --release --test fmi fuzz:: -- --nocapture

verify: build $(VENV)/ready-verify $(MASTERS)/ready ## slow: closed forms, and an independent finite-element code
	SWEEP_ALL=1 cargo test --release --test fmi -- too_little at_any_start
	cargo test --release --features verification --test verification -- --nocapture --test-threads 1
	$(BIN)/python tests/verification/particles.py target/tmp out/verification/particles.png
	$(BIN)/python tests/verification/flows.py target/tmp out/verification
	$(BIN)/python tests/verification/contact.py target/tmp out/verification/contact.png
	$(BIN)/python tests/verification/tension.py target/tmp out/verification
	$(BIN)/python tests/verification/spread.py target/tmp out/verification
	$(BIN)/python tests/verification/independent_code.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python tests/verification/plasticity.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python tests/verification/calculix.py
	$(BIN)/python tests/verification/nonlinear_heat.py
	$(BIN)/python tests/verification/robin_split.py out/verification/robin_split.png

bench: build $(VENV)/ready-verify ## time against an independent finite-element code, and units beside those of others
	$(BIN)/python benches/alumina_plate.py
	$(BIN)/python benches/nonlinear.py
	$(BIN)/python benches/rows.py
	$(BIN)/python benches/units.py
	$(BIN)/python benches/python_unit.py
	OMP_NUM_THREADS=1 $(BIN)/python benches/surfaces.py
	$(BIN)/python benches/studies.py
	$(BIN)/python benches/plans.py
	cargo bench --bench elastic_iterations

charts: build $(VENV)/ready-verify $(PEERS)/ready ## chart errors over time; goes on where it was stopped (needs g++, OpenGL)
	cargo build --release --bench flow_limits
	OMP_NUM_THREADS=1 $(BIN)/python benches/charts/run.py

maps: build $(VENV)/ready ## map where methods fail over two settings each, beside theory; goes on where it was stopped
	cargo build --release --bench flow_limits
	OMP_NUM_THREADS=1 $(BIN)/python benches/maps/run.py

bench-droplet: $(PEERS)/ready ## time droplets against two other particle codes (needs g++ and OpenGL's libraries)
	$(PEERS)/bin/python benches/droplet_peers.py

bench-reduced: build $(VENV)/ready $(PEERS)/ready ## time reduced solids, and the reduction beside pyMOR's (needs cc)
	$(BIN)/python benches/reduced.py
	$(PEERS)/bin/python benches/reduced_peer.py

build:
	cargo build --release --workspace

# Debian ships `venv` apart from Python; it is installed only if it is missing.
$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
		|| { echo "Python 3.11 or later is needed; set PYTHON=…" >&2; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); \
		command -v apt-get > /dev/null || exit 1; \
		sudo=; [ "$$(id -u)" = 0 ] || sudo=sudo; \
		$$sudo apt-get update && $$sudo apt-get install -y --no-install-recommends python3-venv \
		&& $(PYTHON) -m venv $(VENV); }

# The package is installed as it stands: changes of its sources need no new installation.
$(VENV)/ready: python/requirements.txt python/pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r python/requirements.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-build-isolation --no-deps -e ./python
	@touch $@

$(VENV)/ready-verify: python/requirements-verify.txt $(VENV)/ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r python/requirements-verify.txt
	@touch $@

$(PEERS)/ready: python/requirements-peers.txt | $(VENV)/bin/python
	@$(BIN)/python -m venv $(PEERS)
	$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check -r python/requirements-peers.txt
	@touch $@

$(MASTERS)/ready: python/requirements-masters.txt | $(VENV)/bin/python
	@$(BIN)/python -m venv $(MASTERS)
	$(MASTERS)/bin/python -m pip install --quiet --disable-pip-version-check -r python/requirements-masters.txt
	@touch $@

clean: ## remove everything that was built
	cargo clean
	rm -rf $(VENV) $(PEERS) $(MASTERS) out .pytest_cache .ruff_cache python/build python/impinge.egg-info
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
