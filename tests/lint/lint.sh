#!/usr/bin/env bash
# Checks everything that can be checked without running it. Every step prints
# one line; a step that fails prints what it found, and the rest still runs.
# SPDX-License-Identifier: Apache-2.0
#
# usage: lint.sh VENV
#   VENV   Python environment that `make setup` has made
#
# Needs build/firmware/sfr.h, so build the firmware first (`make lint` does).
set -euo pipefail

venv=$(realpath "$1")
cd "$(dirname "$0")/../.."
failures=0

# step NAME COMMAND...: runs it, shows its output only when it fails.
step() {
    local name=$1 output start=$SECONDS
    shift
    if output=$("$@" 2>&1); then
        printf 'lint: %-34s ok, %d s\n' "$name" $((SECONDS - start))
    else
        printf 'lint: %-34s FAILED\n%s\n' "$name" "$output"
        failures=$((failures + 1))
    fi
}

# tracked PATTERN...: files of the project, new ones that git does not ignore
# included, deleted ones not.
tracked() {
    git ls-files --cached --others --exclude-standard -- "$@" | sort -u |
        while read -r file; do
            [ ! -f "$file" ] || printf '%s\n' "$file"
        done
}

mapfile -t firmware_c < <(tracked 'firmware/*.c' 'firmware/*.h')
mapfile -t native < <(tracked 'tests/virtual_lathe/native/*.cc' \
    'tests/virtual_lathe/native/*.hh' 'tests/virtual_lathe/native/*.h')
mapfile -t assembly < <(tracked 'firmware/*.asm' 'firmware/*.inc' 'tests/*.asm')
mapfile -t python < <(tracked '*.py')
mapfile -t shell < <(tracked '*.sh' .ci/run)
mapfile -t formatted < <(printf '%s\n' "${firmware_c[@]}" "${native[@]}" |
    grep -vx -e firmware/link/protocol.h -e firmware/panel/menus.h)

# --- C ------------------------------------------------------------------------
# The words that only SDCC knows are defined away; a special function register
# is an ordinary variable then.
check_c() {
    [ -f build/firmware/sfr.h ] || {
        echo "build/firmware/sfr.h is missing: run make firmware"
        return 1
    }
    cppcheck --quiet --std=c99 --platform=avr8 --error-exitcode=1 \
        --enable=all --suppressions-list=tests/lint/cppcheck-suppressions.txt \
        -D__code= -D__data= '-D__interrupt(level)=' -D__sfr=extern \
        '-D__at(address)=' -Ifirmware -Ibuild/firmware firmware
}

# --- limits of length -----------------------------------------------------------
# short_enough COLUMNS LINES FILE...
short_enough() {
    local columns=$1 lines=$2
    shift 2
    local bad=0
    # grep counts characters where mawk counts bytes.
    if LC_ALL=C.UTF-8 grep -nHE "^.{$((columns + 1))}" "$@"; then
        printf 'at most %d columns\n' "$columns"
        bad=1
    fi
    awk -v lines="$lines" '
        FNR == lines {
            printf "%s: %d lines or more, fewer than %d wanted\n", FILENAME,
                lines, lines
            bad = 1
        }
        END { exit bad }' "$@" || bad=1
    return "$bad"
}

# --- words ------------------------------------------------------------------------
# A file that names a directory of somebody's machine works nowhere else, and
# where packages come from is the user's choice. Addresses that are part of a
# longer one (a URL, a relative path) are not meant.
no_machine_paths() {
    local places='(^|[^[:alnum:]_./~}<-])/(hom[e]|roo[t]|tm[p]|wor[k]|User[s])/'
    local hosts='(pyp[i]|pythonhoste[d]|npmj[s]|crate[s])\.(org|com|io)'
    ! git grep --untracked -nIE "$places|$hosts" -- . ':!LICENSE' ':!hw/*.kicad_*'
}

# A check that was switched off, or work left for later, hides in these words.
nothing_put_off() {
    local words='# noq[a]|type: ignor[e]|TOD[O]|FIXM[E]|mark\.(ski[p]|xfai[l])'
    ! git grep --untracked -nE "$words|pytest\.(ski[p]|xfai[l])" -- \
        '*.py' '*.c' '*.h' '*.cc' '*.hh' '*.asm' '*.sh' '*.md'
}

# Every source says under which licence it stands.
licensed() {
    local file missing=0
    for file in "$@"; do
        grep -q 'SPDX-License-Identifier' "$file" || [ ! -s "$file" ] || {
            echo "$file: no SPDX-License-Identifier line"
            missing=1
        }
    done
    return $missing
}

# Every room says what lives in it.
readmes() {
    local room missing=0
    for room in firmware firmware/*/ host-cli hw tests tests/*/; do
        [ -n "$(git ls-files --cached --others --exclude-standard "$room")" ] ||
            continue
        [ -f "$room/README.md" ] || {
            echo "${room%/}/README.md is missing"
            missing=1
        }
    done
    return $missing
}

shell_syntax() {
    local file
    for file in "$@"; do
        bash -n "$file" || return 1
    done
}

in_host_cli() (cd host-cli && "$@")

step "cppcheck firmware" check_c
step "clang-format" clang-format --dry-run --Werror "${formatted[@]}"
# A generated file is as long as what it is generated from.
mapfile -t written_c < <(printf '%s\n' "${firmware_c[@]}" |
    grep -vx firmware/link/protocol.h)
mapfile -t written_python < <(printf '%s\n' "${python[@]}" |
    grep -vx host-cli/src/tornillo/protocol.py)
step "C in 80 columns, under 400 lines" short_enough 80 400 "${written_c[@]}" \
    "${native[@]}" "${assembly[@]}"
step "Python in 100 columns, under 400" short_enough 100 400 \
    "${written_python[@]}"
step "ruff check" "$venv/bin/ruff" check --quiet .
step "ruff format" "$venv/bin/ruff" format --quiet --diff .
step "mypy host-cli" in_host_cli "$venv/bin/mypy"
step "mypy firmware and tests" "$venv/bin/mypy" firmware/toolchain firmware/link \
    firmware/panel docs tests host-cli/make_catalogues.py
step "mypy hw" "$venv/bin/mypy" --config-file hw/mypy.ini hw
step "protocol files up to date" "$venv/bin/python" \
    firmware/link/generate_protocol.py --check
step "menus of the panel up to date" "$venv/bin/python" \
    firmware/panel/generate_menus.py --check
step "documentation tables up to date" "$venv/bin/python" \
    docs/generate_tables.py --check
step "documentation reference up to date" "$venv/bin/python" \
    docs/generate_reference.py --check
step "catalogues of messages up to date" "$venv/bin/python" \
    host-cli/make_catalogues.py --check
step "bash -n" shell_syntax "${shell[@]}"
step "shellcheck" shellcheck --severity=warning "${shell[@]}"
step "licence lines" licensed "${firmware_c[@]}" "${native[@]}" "${assembly[@]}" \
    "${python[@]}" "${shell[@]}"
step "a README in every room" readmes
step "nothing of one machine" no_machine_paths
step "nothing put off" nothing_put_off

if [ $failures -gt 0 ]; then
    echo "lint: $failures of the steps above failed"
    exit 1
fi
