# What a stranger, a developer and CI call, all alike. Nothing but `deps` calls a system package manager.

SHELL := /bin/sh
.DEFAULT_GOAL := help
.PHONY: help deps need venv build demo test test-all check docs bench wheel stranger

HOUSE ?= builtin:apartment
OUT ?= out/demo
# VIEWER=no leaves the Rerun SDK out (a download of some 150 MB).
VIEWER ?= yes

stage := sh xtask/sh/stage.sh
locked := $(if $(filter true,$(CI)),--locked)
bin := .venv/bin

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/\1\t\2/p' Makefile | awk -F '\t' '{ printf "make %-10s%s\n", $$1, $$2 }'

deps: ## optional system packages by apt (software Vulkan); survives where apt or root is missing
	@sh xtask/sh/deps.sh

need:
	@sh xtask/sh/need.sh

venv: need ## .venv in the root, with dwell in it
	@$(stage) 'extension and .venv' sh xtask/sh/venv.sh

build: need ## everything the tests run
	@sh xtask/sh/build.sh $(locked)

demo: venv ## walk an agent through HOUSE and write what it saw, heard and did to OUT
	@[ '$(VIEWER)' = no ] || sh xtask/sh/viewer.sh
	$(bin)/dwell demo $(HOUSE) --out $(OUT)
	@echo "Open $(OUT)/index.html"

test: build ## Rust, doc and Python tests; of the long ones a share, chosen by the commit
	@status=0; \
	$(stage) 'Rust tests' sh xtask/sh/rust-tests.sh $(locked) || status=1; \
	$(stage) 'doc tests' cargo test $(locked) --workspace --doc --quiet || status=1; \
	$(stage) 'Python tests' sh xtask/sh/python-tests.sh || status=1; \
	exit $$status

test-all: export DWELL_TEST_ALL = 1
test-all: test ## the same with all long and slow tests, and the benches once each
	@$(stage) 'benches, once each' sh xtask/sh/benches.sh --once $(locked)

check: venv ## formatting, lints, docs, layers, sizes, licences, types
	@cargo xtask check

docs: venv ## guide and reference as a site in out/site; every link is checked
	@$(stage) 'site' sh xtask/sh/docs.sh

bench: venv ## figures of every stage
	@sh xtask/sh/benches.sh $(locked)
	for what in load render physics acoustics env; do $(bin)/dwell bench $$what $(HOUSE) || exit 1; done

wheel: venv ## the wheel that strangers install, in dist/
	@$(stage) 'wheel' sh xtask/sh/wheel.sh $(locked)
	@cargo xtask sizes

stranger: ## installs that wheel without Rust and without network, and measures what a stranger meets
	@$(stage) 'stranger' sh xtask/sh/stranger.sh
