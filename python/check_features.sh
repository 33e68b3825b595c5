#!/usr/bin/env bash
# The wheel and the library of FMUs must not compile the workspace a second time: what the program and they share has to have
# the same versions and features in both. Where they differ, let the root Cargo.toml ask for the same features.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# without the path and the mark of packages that are listed before
graph() {
    cargo tree --locked --quiet --edges normal,build --prefix none --format '{p} {f}' "$@" | sed 's/ (\/[^)]*)//; s/ (\*)$//' | sort -u
}

# as `cargo run --release` builds it
shared=$(graph --package ropewalk)
for library in ropewalk-python ropewalk-fmu; do
    own=$(graph --package "$library")
    new=$(comm -13 <(echo "$shared") <(echo "$own") | grep -vE "^(pyo3|pyo3-[a-z-]+|$library|target-lexicon) " || true)
    if [ -n "$new" ]; then
        printf '%s would compile these a second time:\n%s\n' "$library" "$new" >&2
        exit 1
    fi
done
