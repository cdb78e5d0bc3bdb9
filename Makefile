# The commands of a user (impact) and of a developer (the rest). Each installs what it lacks
# through jobs/install-deps.sh, which is silent when nothing does.

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
.PHONY: help deps test-deps release impact test run-tests check check-fast validation fuzz fuzz-memory soak mpich pictures image deb contact-lab bench bench-kernels docs book clean

# The environment of every build and launch: Open MPI's settings, HDF5_DIR.
ENV := source jobs/env.sh;
PROGRAM := target/$(if $(filter mpich,$(WHIPPLE_MPI)),mpich/)release/whipple
VENV := target/venv
TOOLS := target/tools
MDBOOK := 0.5.4
MDBOOK_KATEX := 0.10.0
CARGO_DEB := 3.8.0

help: ## Say what each target does
	@sed -nE 's/^([a-z-]+):.*## (.*)/\1\t\2/p' Makefile | expand -t 16

# Debris of glass has no stripes; the input has the paper's lattice.
GLASS := --set body.plate.lattice=glass --set body.sphere.lattice=glass

impact: release ## Run the main job on two ranks, draw its pictures, write the page that tells it
	jobs/run.sh -n 2 inputs/quarter-impact $(GLASS) --out runs/quarter-impact --force
	$(ENV) $(PROGRAM) plot runs/quarter-impact --panels
	$(ENV) $(PROGRAM) plot runs/quarter-impact --history
	$(ENV) $(PROGRAM) info runs/quarter-impact
	$(ENV) $(PROGRAM) report runs/quarter-impact

test: run-tests ## Run the test suite, 12 to 21 minutes on two cores with its build

check-fast: test-deps ## What takes a minute after an edit: format, lints, the unit tests of all crates
	$(ENV) cargo fmt --all --check
	$(ENV) cargo clippy --locked --workspace -- -D warnings
	$(ENV) cargo nextest run --locked --workspace --lib

check: ## What must pass before a change lands: format, lints, documentation, tests
check: test-deps
	$(ENV) cargo fmt --all --check
	$(ENV) cargo clippy --locked --workspace --all-targets -- -D warnings
	$(ENV) RUSTDOCFLAGS="-D warnings" cargo doc --locked --workspace --no-deps
	$(MAKE) run-tests

fuzz: test-deps ## Read random inputs, surfaces and files of results for ten minutes each; new ones stay in tests/fuzz/
	$(ENV) WHIPPLE_FUZZ_SECONDS=600 cargo test --locked --test fuzz -- --nocapture --test-threads=1

fuzz-memory: test-deps ## Read random files of results under valgrind for SECONDS=600
	@command -v valgrind >/dev/null || { echo "fuzz-memory needs valgrind: apt install valgrind" >&2; exit 2; }
	$(ENV) host=$$(rustc -vV | sed -n 's/^host: //p' | tr a-z- A-Z_); \
	env WHIPPLE_FUZZ_SECONDS=$(or $(SECONDS),600) \
	    "CARGO_TARGET_$${host}_RUNNER=valgrind --quiet --error-exitcode=9 --suppressions=$(CURDIR)/tests/fuzz/valgrind.supp" \
	    cargo test --locked --test fuzz files -- --nocapture --test-threads=1

soak: release ## Kill, stop and restart a run at random for MINUTES=30, with SEED=1; the bits must stay
	tests/soak.sh -m $(or $(MINUTES),30) -s $(or $(SEED),1)

mpich: ## Build with MPICH and with Open MPI, compare their bits, run tests of real ranks with MPICH
	jobs/mpich.sh

validation: test-deps $(VENV)/ready ## Run the slow physics tests and draw the pictures
	$(ENV) jobs/cargo-test.sh --ignored
	$(MAKE) pictures

pictures: release ## Run the cases of the validation page and draw its pictures
	jobs/validation-pictures.sh

contact-lab: release ## Measure contact on small cases, write the tables of the book's page on it
	jobs/contact-lab.sh

bench: release ## Time fixed cases on threads and ranks, beside other programs where installed
	$(ENV) $(PROGRAM) bench --json target/bench.json
	if [ -x benches/peers/run.sh ]; then $(ENV) benches/peers/run.sh; fi

bench-kernels: deps ## Time the inner loops alone, for each instruction set
	$(ENV) cargo bench --locked -p whipple-kernels

docs: deps book ## Build the book (target/book) and the API documentation (target/doc)
	$(ENV) cargo doc --locked --workspace --no-deps

# The book alone. A page that reaches for the network, or an equation that is not typeset, is an error.
book: $(TOOLS)/ready-$(MDBOOK)-$(MDBOOK_KATEX)
	PATH="$(CURDIR)/$(TOOLS)/bin:$$PATH" mdbook build docs
	jobs/check-book.sh target/book

clean: ## Remove what was built; runs/ stays
	rm -rf target

deps:
	@jobs/install-deps.sh

test-deps:
	@jobs/install-deps.sh --tests

# The commit goes into summaries and snapshots.
release: deps
	$(ENV) WHIPPLE_COMMIT=$$(git describe --always --dirty 2>/dev/null || echo unknown) \
	    cargo build --locked --release

image: ## Make target/whipple.sif, a container, with Apptainer
	mkdir -p target
	apptainer build --force --build-arg commit=$$(git describe --always --dirty 2>/dev/null || echo unknown) \
	    --build-arg mpi=$(or $(WHIPPLE_MPI),openmpi) \
	    target/whipple.sif jobs/whipple.def

deb: release ## Make target/debian/whipple_….deb: the program, man pages, completions, jobs/ and inputs/
deb: $(TOOLS)/cargo-deb-$(CARGO_DEB)
	rm -rf target/package target/debian
	mkdir -p target/package
	$(ENV) target/release/whipple generate man target/package/man
	target/release/whipple generate completions bash >target/package/whipple.bash
	target/release/whipple generate completions zsh >target/package/_whipple
	target/release/whipple generate completions fish >target/package/whipple.fish
	$(ENV) PATH="$(CURDIR)/$(TOOLS)/bin:$$PATH" cargo deb --locked --no-build --strip

run-tests: test-deps $(VENV)/ready
	$(ENV) jobs/cargo-test.sh

# mdBook, which makes the book, and what typesets its equations as it does; the two go together.
$(TOOLS)/ready-$(MDBOOK)-$(MDBOOK_KATEX):
	$(ENV) cargo install --locked --root $(TOOLS) --target-dir $(TOOLS)/build mdbook@$(MDBOOK) \
	    --no-default-features --features search
	$(ENV) cargo install --locked --root $(TOOLS) --target-dir $(TOOLS)/build mdbook-katex@$(MDBOOK_KATEX)
	rm -rf $(TOOLS)/build
	touch $@

# What makes the package. It asks dpkg for the libraries that the program needs.
$(TOOLS)/cargo-deb-$(CARGO_DEB):
	$(ENV) cargo install --locked --root $(TOOLS) --target-dir $(TOOLS)/build cargo-deb@$(CARGO_DEB) \
	    --no-default-features --features gzip
	rm -rf $(TOOLS)/build
	touch $@

# The Python clients that open our files in the tests, at pinned versions.
$(VENV)/ready: tests/clients/requirements.txt | test-deps
	rm -rf $(VENV)
	python3 -m venv $(VENV)
	$(VENV)/bin/pip install --quiet --disable-pip-version-check --retries 5 -r $<
	touch $@
