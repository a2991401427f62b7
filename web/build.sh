#!/usr/bin/env bash
# Compiles the engine to WebAssembly for the pages of `apportion live`: gzip in base64, and the digest of its sources.
#
#     web/build.sh            writes assets/web/engine.b64 and assets/web/sources.sha256
#     web/build.sh FOLDER     writes them to FOLDER instead; exit code 1 if the digest is not that of assets/web
#
# Needs the target wasm32-unknown-unknown, which rustup adds; zopfli where what it writes is committed.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-assets/web}
mkdir -p "$folder"

# All that the library is compiled from; tests and the program do not count.
find Cargo.toml src web/Cargo.toml web/Cargo.lock web/src templates/page assets/joe-kuo assets/fonts assets/pick-freeze -type f \
  ! -path '*/tests/*' ! -name tests.rs ! -path 'src/cli/*' ! -path 'src/reproduce/*' ! -path 'src/scene/*' ! -path src/live.rs ! -path src/main.rs -print0 |
  LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum | cut -d ' ' -f 1 >"$folder/sources.sha256"

rustup target list --installed 2>/dev/null | grep -q wasm32-unknown-unknown || rustup target add wasm32-unknown-unknown
target=${CARGO_TARGET_DIR:-$PWD/target}/web
# No paths of this machine in what is published.
export RUSTFLAGS="--remap-path-prefix=$PWD=. --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo"
CARGO_TARGET_DIR=$target cargo build --quiet --release --locked --target wasm32-unknown-unknown --manifest-path web/Cargo.toml
# zopfli writes gzip that is a twentieth smaller.
pack=(gzip -9nc)
command -v zopfli >/dev/null && pack=(zopfli -c)
"${pack[@]}" "$target/wasm32-unknown-unknown/release/apportion_web.wasm" | base64 -w 0 >"$folder/engine.b64"
echo "wrote $folder/engine.b64, $(wc -c <"$folder/engine.b64") bytes"

if ! cmp -s "$folder/sources.sha256" assets/web/sources.sha256
then
  echo "assets/web/engine.b64 was built from other sources: run web/build.sh and commit what it writes"
  exit 1
fi
