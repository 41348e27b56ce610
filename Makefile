# Tornillo: firmware, command line, virtual lathe and board.
# SPDX-License-Identifier: Apache-2.0
#
# Every target sets up what it needs first; "make help" lists them.

SHELL := /bin/bash
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
MAKEFLAGS += --no-print-directory

CACHE := $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/tornillo
VENV := .venv
PYTHON := $(VENV)/bin/python
SETUP_STAMP := build/setup.stamp

.PHONY: help
help: ## list the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sort | \
	  sed -E 's/^([a-z-]+):[^#]*## /  make \1\t/' | expand -t 24

.PHONY: setup
setup: ## install what is missing: packages, compiler, Python environment
	@firmware/toolchain/setup.sh $(CACHE) $(VENV) $(SETUP_STAMP)

# Needed by everything that is built; runs at every make, in 0.1 s.
$(SETUP_STAMP): setup ;

include firmware/firmware.mk
include tests/virtual_lathe/build.mk
-include hw/hw.mk

.PHONY: demo
demo: firmware virtual-lathe-library ## cut the test bar on the virtual lathe, measure it, draw it
	@$(PYTHON) tests/demo/demo.py

.PHONY: virtual-lathe
virtual-lathe: firmware virtual-lathe-library ## run a virtual lathe; options in ARGS="..."
	@$(PYTHON) -m virtual_lathe $(ARGS)

.PHONY: test
test: firmware firmware-bus-powered virtual-lathe-library ## all tests: host, firmware on the simulated chip, end to end
	@$(PYTHON) -m pytest --cov=tornillo --cov-branch --cov-report=term $(PYTEST_ARGS)

.PHONY: test-kernel
test-kernel: firmware virtual-lathe-library ## cut a part through the USB driver of a real Linux kernel
	@tests/kernel/setup.sh $(CACHE)
	@TORNILLO_REFRESH_DESCRIPTORS=$(REFRESH) $(PYTHON) -m pytest tests/kernel/check_linux.py

.PHONY: fuzz
fuzz: firmware virtual-lathe-library ## a million USB transfers and frames of nonsense, some minutes
	@$(PYTHON) -m fuzz.fuzz $(ARGS)

.PHONY: lint
lint: firmware ## cppcheck, clang-format, ruff, mypy, generated files up to date
	@tests/lint/lint.sh $(VENV)

.PHONY: bench
bench: firmware virtual-lathe-library ## measure, write build/bench/bench.json and docs/benchmarks.md
	@$(PYTHON) tests/bench/bench.py

.PHONY: docs
docs: firmware virtual-lathe-library ## refresh what is generated in docs/, build build/site
	@$(PYTHON) firmware/link/generate_protocol.py
	@$(PYTHON) firmware/panel/generate_menus.py
	@$(PYTHON) docs/generate_tables.py
	@$(PYTHON) docs/generate_reference.py
	@$(PYTHON) docs/generate_pictures.py
	@$(PYTHON) -m mkdocs --quiet build --strict
	@echo "build/site/index.html"

.PHONY: catalogues
catalogues: | $(SETUP_STAMP) ## collect all messages, list those without a translation, compile
	@$(PYTHON) host-cli/make_catalogues.py

.PHONY: wheel
wheel: | $(SETUP_STAMP) ## build the package for pip and pipx into build/wheel
	@$(PYTHON) -m pip wheel --quiet --no-deps --no-build-isolation -w build/wheel ./host-cli
	@ls build/wheel/*.whl

.PHONY: clean
clean: ## remove build/ and the Python environment; the compiler cache stays
	rm -rf build $(VENV)
