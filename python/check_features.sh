#!/usr/bin/env bash
# The wheel must not compile the workspace a second time: what the program and the Python module share has to have the
# same versions and features in both. Where they differ, let the root Cargo.toml ask for the same features.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# without the path and the mark of packages that are listed before
graph() {
    cargo tree --locked --quiet --edges normal,build --prefix none --format '{p} {f}' "$@" | sed 's/ (\/[^)]*)//; s/ (\*)$//' | sort -u
}

# as `cargo run --release` builds it
shared=$(graph --package ropewalk)
module=$(graph --package ropewalk-python)
new=$(comm -13 <(echo "$shared") <(echo "$module") | grep -vE '^(pyo3|pyo3-[a-z-]+|ropewalk-python|target-lexicon) ' || true)
if [ -n "$new" ]; then
    printf 'the Python module would compile these a second time:\n%s\n' "$new" >&2
    exit 1
fi
