# Every target does its own set-up; it needs cargo, a C linker and Python 3.11 or later.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PEERS := .venv-peers
MASTERS := .venv-masters
TOOLS := .venv-dist
NAMES := $(sort $(patsubst examples/%/scene.toml,%,$(wildcard examples/*/scene.toml)))
EXAMPLES := $(sort $(patsubst examples/%/run.py,%,$(wildcard examples/*/run.py)))
RELEASE := target/release
# Built for C libraries from 2018 on, and for Windows.
OLDEST_GLIBC := 2.28
LINUX := target/dist/x86_64-unknown-linux-gnu/release
WINDOWS := target/win64/x86_64-win7-windows-gnu
WIN64 := $(WINDOWS)/release
PY_FILES := $(wildcard python build-fmu/*.py tests/conftest.py tests/fmpy tests/python tests/verification benches examples docs/conf.py docs/manual packaging tests/windows tests/wheel)

.DEFAULT_GOAL := help

.PHONY: help install dist wheels win64 win64-test wheel-test demo docs units examples test rust-test python-test pytest fuzz verify bench charts maps bench-droplet bench-reduced build clean

help: ## say what there is
	@grep -hE '^[a-z0-9-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z0-9-]+):.*## /  make \1\t/' | expand -t 20

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

# Packages are installed while the compiler runs. Once all is built, tests in Python fill the cores while the compiler of
# further Rust tests leaves them idle. A failure of one does not cut the other short.
test: ## everything that is fast
	@$(MAKE) --no-print-directory --jobs=2 --output-sync=target build $(VENV)/ready
	@$(MAKE) --no-print-directory --jobs=2 --keep-going --output-sync=target rust-test pytest

# All test programs but that of `make verify`.
FOLDERS := $(notdir $(patsubst %/main.rs,%,$(wildcard tests/*/main.rs cli/tests/*/main.rs)))
TESTS := $(filter-out verification,$(FOLDERS)) \
	$(basename $(notdir $(wildcard tests/*.rs build-fmu/tests/*.rs)))

# Tests within the library compile it once more, for themselves: without optimisation that takes a fifth of the time,
# and they check for overflows and debug assertions, too. All other tests run what is packed. Each selects from the whole
# workspace: a selection of single packages has other features of dependencies, which builds the library once more.
UNOPTIMISED := --config profile.release.package.impinge.opt-level=0 \
	--config profile.release.package.impinge.debug-assertions=true \
	--config profile.release.package.impinge.overflow-checks=true

rust-test:
	cargo fmt --all --check
	cargo clippy --release --workspace --all-targets -- -D warnings
	cargo test --release --workspace --bins $(TESTS:%=--test %)
	cargo test --release --workspace --exclude impinge --lib
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
	SWEEP_ALL=1 cargo test --release --test suite -- layers_freeze layers_cool any_number_of_drops like_drops faces_of_different half_a_turn \
		every_pair_takes the_time_until_edges balances_close_for_all_fluids \
		sheets_of_four_corners
	cargo test --release --features verification --test verification -- --nocapture --test-threads 1
	$(BIN)/python tests/verification/particles.py target/tmp out/verification/particles.png
	$(BIN)/python tests/verification/flows.py target/tmp out/verification
	$(BIN)/python tests/verification/contact.py target/tmp out/verification/contact.png
	$(BIN)/python tests/verification/tension.py target/tmp out/verification
	$(BIN)/python tests/verification/spread.py target/tmp out/verification
	$(BIN)/python tests/verification/independent_code.py
	IMPINGE_BIN=$(CURDIR)/$(RELEASE) $(BIN)/python -m pytest tests/verification/test_paraview.py tests/verification/test_units.py \
		tests/verification/test_gcode_motion.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python tests/verification/plasticity.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python tests/verification/calculix.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python tests/verification/relaxation.py
	$(BIN)/python tests/verification/nonlinear_heat.py
	$(BIN)/python tests/verification/strands.py
	$(BIN)/python tests/verification/lattice.py
	$(BIN)/python tests/verification/cracks_beside_faces.py
	$(BIN)/python tests/verification/cracks_in_rows.py
	$(BIN)/python tests/verification/robin_split.py out/verification/robin_split.png
	@$(MAKE) --no-print-directory wheel-test

bench: build $(VENV)/ready-verify ## time against an independent finite-element code, and units beside those of others
	$(BIN)/python benches/alumina_plate.py
	$(BIN)/python benches/nonlinear.py
	$(BIN)/python benches/rows.py
	$(BIN)/python benches/units.py
	$(BIN)/python benches/python_unit.py
	OMP_NUM_THREADS=1 $(BIN)/python benches/surfaces.py
	$(BIN)/python benches/studies.py
	$(BIN)/python benches/plans.py
	$(BIN)/python benches/paths.py
	$(BIN)/python benches/pressure.py
	cargo build --release --bench cracks
	$(BIN)/python benches/cracks_peer.py
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

PREFIX ?= $(HOME)/.local

install: build ## programs, library, completions and manual pages below PREFIX (~/.local), without the Python package
	$(PYTHON) packaging/stage.py $(PREFIX) --programs $(RELEASE) --library linux64=$(RELEASE)/libimpinge.so

# The library and the programs for Windows, with the packages of Debian 12 alone: its compiler brings the sources of the
# standard library. It is on the PATH of this rule alone, so the usual compiler stays what it is.
WIN64_PACKAGES := rustc-web cargo-web rust-web-src gcc-mingw-w64-x86-64

win64: ## the library and the programs for Windows; units packed from then on carry both (Debian 12, installs packages)
	@dpkg -s $(WIN64_PACKAGES) > /dev/null 2>&1 || $(call apt,$(WIN64_PACKAGES))
	PATH=/usr/bin:/bin RUSTC_BOOTSTRAP=1 CARGO_TARGET_X86_64_WIN7_WINDOWS_GNU_LINKER=x86_64-w64-mingw32-gcc \
		cargo build -Zbuild-std=std,panic_unwind --target x86_64-win7-windows-gnu --target-dir target/win64 \
		--release --package impinge --package impinge-cli --package build-fmu
	@mkdir -p $(RELEASE)/win64
	cp $(WIN64)/impinge.dll $(RELEASE)/win64/

win64-test: win64 build $(VENV)/ready ## drive Windows units under Wine, beside the same on Linux (installs wine)
	@dpkg -s wine64 > /dev/null 2>&1 || $(call apt,wine wine64)
	IMPINGE_BIN=$(CURDIR)/$(RELEASE) IMPINGE_WIN64=$(CURDIR)/$(WIN64) $(BIN)/python -m pytest tests/windows

# What `make win64` has built goes into the wheels; nothing else does.
DLL = $(wildcard $(WIN64)/impinge.dll)
LIBRARIES = --library linux64=$(LINUX)/libimpinge.so $(DLL:%=--library win64=%)

wheels: $(TOOLS)/ready $(VENV)/ready
	PATH=$(CURDIR)/$(TOOLS)/bin:$$PATH cargo zigbuild --target x86_64-unknown-linux-gnu.$(OLDEST_GLIBC) \
		--target-dir target/dist --release --package impinge --package impinge-cli --package build-fmu
	rm -rf target/dist/linux target/dist/windows
	$(BIN)/python packaging/stage.py target/dist/linux --programs $(LINUX) $(LIBRARIES)
	$(BIN)/python packaging/wheel.py target/dist/linux $(LINUX_TAG) -o dist
	@set -e; [ -z "$(DLL)" ] || { \
		$(BIN)/python packaging/stage.py target/dist/windows --programs $(WIN64) --describe $(LINUX) $(LIBRARIES); \
		$(BIN)/python packaging/wheel.py target/dist/windows win_amd64 -o dist; }
	$(TOOLS)/bin/auditwheel show dist/*$(LINUX_TAG).whl

LINUX_TAG := manylinux_2_28_x86_64

dist: ## wheels, units of all examples, completions, manual pages and checksums in dist/
	rm -rf dist
	@$(MAKE) --no-print-directory wheels
	@mkdir -p dist/units
	@set -e; for scene in examples/*/*.toml; do \
		name=$$(echo $$scene | sed -E 's,examples/(.*)\.toml,\1,; s,/scene$$,,; s,/,_,'); \
		target/dist/linux/bin/build-fmu $$scene -o dist/units/$$name.fmu \
			--platform linux64 $(if $(DLL),--platform win64); done
	cp -r target/dist/linux/share dist/share && rm -r dist/share/impinge/*64
	@cd dist && find . -type f ! -name SHA256SUMS | LC_ALL=C sort | xargs sha256sum > SHA256SUMS
	@cd dist && sha256sum --check --quiet SHA256SUMS && ls -lh . units

wheel-test: wheels ## install the wheel in a fresh environment; pack, run and plot a unit
	$(BIN)/python -m pytest tests/wheel

# Installs packages of Debian.
define apt
{ command -v apt-get > /dev/null || { echo "This needs Debian's packages: $(1)" >&2; exit 1; }; \
	sudo=; [ "$$(id -u)" = 0 ] || sudo=sudo; \
	$$sudo apt-get update && $$sudo apt-get install -y --no-install-recommends $(1); }
endef

# Debian ships `venv` apart from Python; it is installed only if it is missing.
$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
		|| { echo "Python 3.11 or later is needed; set PYTHON=…" >&2; exit 1; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); \
		$(call apt,python3-venv) && $(PYTHON) -m venv $(VENV); }

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

$(TOOLS)/ready: python/requirements-dist.txt | $(VENV)/bin/python
	@$(BIN)/python -m venv $(TOOLS)
	$(TOOLS)/bin/python -m pip install --quiet --disable-pip-version-check -r python/requirements-dist.txt
	@touch $@

clean: ## remove everything that was built
	cargo clean
	rm -rf $(VENV) $(PEERS) $(MASTERS) $(TOOLS) out dist .pytest_cache .ruff_cache python/build python/impinge.egg-info
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
