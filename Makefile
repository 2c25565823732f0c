# make test   build everything, create the Python environment, run every check and test
# make demo   the main job, three ways, with pictures in out/demo
# make bench  timings against CalculiX (if installed), table in out/bench
# make growth      time and memory of the punch from small to large, table and picture in out/bench
# make increments  milliseconds per further increment of a deck that is set up
# make robustness  a thousand random small decks, each failure with its reason in out/robustness
#
# Needs: Rust 1.90 or later, Python 3.11 or later with venv and pip, a C compiler.

PYTHON ?= python3
CARGO ?= cargo
VENV := .venv
BIN := $(VENV)/bin
# The environment carries the checksum of what it was made from; another checksum makes another stamp.
WANTED := $(shell cat tests/requirements.txt clients/python/pyproject.toml | cksum | cut -d' ' -f1)
STAMP := $(VENV)/made-from-$(WANTED)
PYTHON_CODE := tests examples benches docs clients/python

.PHONY: all build env test test-rust test-python check demo bench growth increments robustness clean

all: build

build:
	$(CARGO) build --release --workspace

env: $(STAMP)

$(STAMP):
	$(PYTHON) -m venv --clear $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r tests/requirements.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e clients/python
	touch $@

check: env
	$(CARGO) fmt --all --check
	$(CARGO) clippy --release --workspace --all-targets -- -D warnings
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --release --workspace --no-deps --quiet
	$(BIN)/ruff check $(PYTHON_CODE)
	$(BIN)/ruff format --check $(PYTHON_CODE)

test-rust:
	$(CARGO) test --release --workspace

test-python: build env
	$(BIN)/python -m pytest

test: check build test-rust test-python

demo: build env
	$(BIN)/python examples/demo.py --out out/demo

bench: build env
	$(BIN)/python benches/bench.py --out out/bench

growth: build env
	$(BIN)/python benches/growth.py --out out/bench

increments:
	$(CARGO) bench -p overclosure --bench increments

robustness: build env
	PYTHONPATH=tests:examples $(BIN)/python -m robustness --decks 1000 --out out/robustness

clean:
	rm -rf $(VENV) out
	$(CARGO) clean
