#!/usr/bin/env bash
# Compiles the engine to WebAssembly for the pages of `apportion live`: in gzip, with the licences of what is in it.
#
#     web/build.sh            writes assets/web/engine.wasm.gz (`just engine`)
#     web/build.sh FOLDER     writes it to FOLDER instead
#
# To be run for a release, and when a number on a page changes: `tests/browser/live.py --bits` compares the pages' numbers
# with the program's. Needs the target wasm32-unknown-unknown, which rustup adds; zopfli where what it writes is committed.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-assets/web}
mkdir -p "$folder"

rustup target list --installed 2>/dev/null | grep -q wasm32-unknown-unknown || rustup target add wasm32-unknown-unknown
target=${CARGO_TARGET_DIR:-$PWD/target}/web
# No paths of this machine in what is published.
# Random numbers come from seeds alone: there is no source of them in the page.
export RUSTFLAGS="--cfg getrandom_backend=\"unsupported\" --remap-path-prefix=$PWD=. --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo"
CARGO_TARGET_DIR=$target cargo build --quiet --profile web --locked --target wasm32-unknown-unknown -p apportion-web
# zopfli writes gzip that is a twentieth smaller: pages must not grow by what a machine lacks.
pack=(gzip -9nc)
if command -v zopfli >/dev/null; then pack=(zopfli -c); elif [ $# = 0 ]; then echo "zopfli is missing: a package of the system" >&2; exit 1; fi
"${pack[@]}" "$target/wasm32-unknown-unknown/web/apportion_web.wasm" >"$folder/engine.wasm.gz"
{ cat LICENSE-MIT assets/joe-kuo/LICENSE-JOE-KUO; python3 .ci/licences.py apportion-web wasm32-unknown-unknown; } >"$folder/LICENCES.txt"
echo "wrote $folder/engine.wasm.gz, $(wc -c <"$folder/engine.wasm.gz") bytes"
